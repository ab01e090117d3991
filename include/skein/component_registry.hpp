#pragma once

#include <functional>
#include <map>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "skein/detail/abi.hpp"
#include "skein/detail/operation.hpp"
#include "skein/parameters.hpp"

namespace skein {

class Entity;
class SelectionStrategy;

/// The implementations that a process can run, by component name, and selection strategies in
/// addition to Skein's own. `main()`, or a plugin's `skein_register_components`, fills a registry;
/// there is no global one. Not thread-safe.
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
  /// Runs a mission to its end; returns the mission's exit code.
  using Mission = std::function<int(Entity&, const ParameterValues&)>;

  ComponentRegistry() = default;
  /// `arguments`: what its process was given for its components to read.
  explicit ComponentRegistry(std::vector<std::string> arguments)
      : arguments_(std::move(arguments)) {}

  /// These throw InvalidArgument if the name of the component is taken.
  void add_body(const std::string& component, BodyFactory factory);
  void add_csp(const std::string& component, CspFactory factory);
  void add_mission(const std::string& component, Mission mission);
  /// Makes a strategy selectable by its name, for example as a profile's `strategy`. Throws
  /// InvalidArgument if the name is taken, also by a strategy of Skein's own.
  void add_strategy(std::shared_ptr<const SelectionStrategy> strategy);

  /// These return nullptr if there is no component of that kind.
  const BodyFactory* find_body(const std::string& component) const;
  const CspFactory* find_csp(const std::string& component) const;
  const Mission* find_mission(const std::string& component) const;

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
  /// with these folders if it cannot be loaded, InvalidArgument if it is no plugin or was built for
  /// another version.
  void load_plugin(const std::string& name);

 private:
  void refuse_duplicate(const std::string& component) const;

  std::vector<std::string> arguments_;
  std::map<std::string, BodyFactory> bodies_;
  std::map<std::string, CspFactory> csps_;
  std::map<std::string, Mission> missions_;
  std::vector<std::shared_ptr<const SelectionStrategy>> strategies_;
};

}  // namespace skein
