#pragma once

#include <functional>
#include <map>
#include <memory>
#include <stop_token>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#include "skein/clock.hpp"
#include "skein/detail/abi.hpp"
#include "skein/detail/operation.hpp"
#include "skein/parameters.hpp"

namespace skein {

class Entity;
class SelectionStrategy;

/// The implementations that a process can run, by component name, and selection strategies in
/// addition to Skein's own. `main()`, or a plugin's `skein_register_components`, fills a registry;
/// there is no global one. Not thread-safe.
///
/// ```cpp
/// registry.add_csp<survey::IPlanner>("Rows", [](const skein::ParameterValues&) {
///   return std::make_shared<survey::IPlanner::Skeleton>(std::make_shared<Rows>());
/// });
/// ```
class ComponentRegistry {
 public:
  /// A Body: the public service of an entity.
  struct Body {
    std::shared_ptr<Servant> servant;
    /// How many threads run its calls; a mission profile may set another number.
    std::size_t threads = 1;
    /// Called once before the peer reports that it is ready, when its services are provided and
    /// what it depends on is there. If it throws, the peer ends with that reason. May be empty.
    std::function<void()> self_test{};
  };
  using BodyFactory = std::function<Body(Entity&, const ParameterValues&)>;
  /// Makes a CSP, which implements a managed interface and knows nothing of entities.
  using CspFactory = std::function<std::shared_ptr<Servant>(const ParameterValues&)>;
  /// Runs a mission to its end; returns the mission's exit code. Only a peer with role="mission"
  /// runs it. It is not told to end: its process dies of the signal.
  using Mission = std::function<int(Entity&, const ParameterValues&)>;
  /// What a peer does that provides nothing: it publishes, subscribes, and calls others. Runs on
  /// the process's main thread, once what the peer depends on is there and the peer has reported
  /// that it is ready. `told_to_end` is set when the launcher ends the peer, or by SIGINT, SIGTERM
  /// or SIGHUP (see await_end()); an activity that does not return then is killed after the
  /// profile's `stop_timeout`. It may also return by itself. What it returns is the process's exit
  /// code, and the mission's where its peer has role="mission". What it throws ends the process
  /// with exit code 76.
  using Activity =
      std::function<int(Entity&, const ParameterValues&, const std::stop_token& told_to_end)>;
  /// Makes an activity before the peer reports that it is ready, on the same thread. What it throws
  /// ends the peer with that reason, as what a BodyFactory throws: InvalidArgument ends the
  /// mission.
  using ActivityFactory = std::function<std::function<int(const std::stop_token& told_to_end)>(
      Entity&, const ParameterValues&)>;
  /// Throws if no component can use that value, with the reason.
  using ValueCheck = std::function<void(const ParameterValue&)>;

  ComponentRegistry() = default;
  /// `arguments`: what its process was given for its components to read.
  explicit ComponentRegistry(std::vector<std::string> arguments)
      : arguments_(std::move(arguments)) {}

  /// These throw InvalidArgument if the name of the component is taken.
  void add_body(const std::string& component, BodyFactory factory);
  void add_csp(const std::string& component, CspFactory factory);
  /// As above. `Interface` is what the servants implement, as `survey::IPlanner`: with it `skein
  /// check` compares the component's description before anything starts. Without it, it says that
  /// it could not.
  template <class Interface>
  void add_body(const std::string& component, BodyFactory factory) {
    add_body(component, std::move(factory));
    implemented_[component] = &Interface::interface_info();
  }
  template <class Interface>
  void add_csp(const std::string& component, CspFactory factory) {
    add_csp(component, std::move(factory));
    implemented_[component] = &Interface::interface_info();
  }
  /// What no factory of a Body or a CSP is ends here, with what one returns.
  template <class Interface, class Factory>
  requires(!std::is_convertible_v<Factory, BodyFactory>) void add_body(const std::string&,
                                                                       const Factory&) {
    static_assert(sizeof(Factory) == 0,
                  "the factory of a Body takes (skein::Entity&, const skein::ParameterValues&) and "
                  "returns skein::ComponentRegistry::Body{std::make_shared<INTERFACE::Skeleton>("
                  "std::make_shared<YOUR_CLASS>())}");
  }
  template <class Interface, class Factory>
  requires(!std::is_convertible_v<Factory, CspFactory>) void add_csp(const std::string&,
                                                                     const Factory&) {
    static_assert(sizeof(Factory) == 0,
                  "the factory of a CSP takes (const skein::ParameterValues&) and returns "
                  "std::make_shared<INTERFACE::Skeleton>(std::make_shared<YOUR_CLASS>())");
  }
  /// The same where also the interface is missing.
  template <class Factory>
  requires(!std::is_convertible_v<Factory, BodyFactory>) void add_body(const std::string&,
                                                                       const Factory&) {
    static_assert(
        sizeof(Factory) == 0,
        "a Body is registered with its interface, add_body<INTERFACE>(NAME, FACTORY), and "
        "its factory takes (skein::Entity&, const skein::ParameterValues&) and returns "
        "skein::ComponentRegistry::Body");
  }
  template <class Factory>
  requires(!std::is_convertible_v<Factory, CspFactory>) void add_csp(const std::string&,
                                                                     const Factory&) {
    static_assert(sizeof(Factory) == 0,
                  "a CSP is registered with its interface, add_csp<INTERFACE>(NAME, FACTORY), and "
                  "its factory takes (const skein::ParameterValues&) and returns a "
                  "std::shared_ptr<skein::Servant>");
  }
  void add_mission(const std::string& component, Mission mission);
  void add_activity(const std::string& component, Activity activity);
  void add_activity(const std::string& component, ActivityFactory factory);
  /// Adds to what the dictionary says of a parameter: `skein check` and `skein launch` call `check`
  /// with each value that a profile gives to it in a process that loads this plugin, and tell what
  /// it throws at the value's place; the process itself does so when it begins. A parameter may
  /// have several checks. T is an alternative of ParameterValue; values of other types pass:
  ///
  ///     registry.add_check<std::string>("Sites", parse_sites);
  template <class T>
  void add_check(const std::string& parameter, std::function<void(const T&)> check) {
    add_value_check(parameter, [check = std::move(check)](const ParameterValue& value) {
      if (const T* known = std::get_if<T>(&value)) check(*known);
    });
  }
  /// Makes a strategy selectable by its name, for example as a profile's `strategy`. Throws
  /// InvalidArgument if the name is taken, also by a strategy of Skein's own.
  void add_strategy(std::shared_ptr<const SelectionStrategy> strategy);

  /// These return nullptr if there is no component of that kind.
  const BodyFactory* find_body(const std::string& component) const;
  const CspFactory* find_csp(const std::string& component) const;
  const Mission* find_mission(const std::string& component) const;
  const ActivityFactory* find_activity(const std::string& component) const;
  /// What a Body or a CSP implements; nullptr if its registration does not say it.
  const InterfaceInfo* find_interface(const std::string& component) const;

  /// Throws what the first check of the parameter throws that refuses the value.
  void check_value(const std::string& parameter, const ParameterValue& value) const;

  /// The `<argument>` elements of the process in its mission profile: what follows `--` on the
  /// command line of `skein peer`.
  const std::vector<std::string>& arguments() const noexcept { return arguments_; }

  /// In the order in which they were added.
  const std::vector<std::shared_ptr<const SelectionStrategy>>& strategies() const noexcept {
    return strategies_;
  }

  /// Names of all components, sorted.
  std::vector<std::string> names() const;

  /// Loads a plugin (it is never unloaded) and calls its `skein_register_components`. `name` is a
  /// path, or a name such as `skein_navigation_components` for `libskein_navigation_components.so`,
  /// which is searched in the folders of SKEIN_MODULE_PATH and beside libskein. Throws Unavailable
  /// with these folders if it cannot be loaded, and with its own reason if it throws while it
  /// registers its components; InvalidArgument if it is no plugin, was built for another version,
  /// registers what is there already, or lies where every user may write: it is not loaded then.
  void load_plugin(const std::string& name);

 private:
  void refuse_duplicate(const std::string& component) const;
  void add_value_check(const std::string& parameter, ValueCheck check);

  std::vector<std::string> arguments_;
  std::map<std::string, BodyFactory> bodies_;
  std::map<std::string, CspFactory> csps_;
  std::map<std::string, Mission> missions_;
  std::map<std::string, ActivityFactory> activities_;
  std::map<std::string, const InterfaceInfo*> implemented_;
  std::vector<std::shared_ptr<const SelectionStrategy>> strategies_;
  std::multimap<std::string, ValueCheck> checks_;
};

/// Waits until an activity is told to end, and no longer than `at_most` by the entity's clock.
/// Whether it was told:
///
///     while (!await_end(entity, told_to_end, 100ms)) poses.publish(pose());
bool await_end(Entity& entity, const std::stop_token& told_to_end,
               Duration at_most = Duration::max());

}  // namespace skein
