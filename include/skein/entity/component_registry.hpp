#pragma once

#include <functional>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "skein/core/operation.hpp"
#include "skein/entity/parameters.hpp"

namespace skein {

class Entity;

/// The implementations that a process can run, by component name. `main()` fills one, or a plugin's
/// `skein_register_components`; there is no global one.
class ComponentRegistry {
 public:
  /// A Body: the public service of an entity, and how many threads run its calls.
  struct Body {
    std::shared_ptr<Servant> servant;
    std::size_t threads = 1;
  };
  using BodyFactory = std::function<Body(Entity&, const ParameterValues&)>;
  /// Makes a CSP, which knows its managed interface and nothing of entities.
  using CspFactory = std::function<std::shared_ptr<Servant>(const ParameterValues&)>;
  /// Runs a mission to its end; the result is the mission's exit code.
  using Mission = std::function<int(Entity&, const ParameterValues&)>;

  /// Throw InvalidArgument where the name is taken.
  void add_body(const std::string& component, BodyFactory factory);
  void add_csp(const std::string& component, CspFactory factory);
  void add_mission(const std::string& component, Mission mission);

  /// Null where the component is not of that kind.
  const BodyFactory* find_body(const std::string& component) const;
  const CspFactory* find_csp(const std::string& component) const;
  const Mission* find_mission(const std::string& component) const;

  /// All names, sorted.
  std::vector<std::string> names() const;

  /// Loads a plugin (never unloaded) and lets it register. `name` is `skein_navigation_components`
  /// for `libskein_navigation_components.so`, or a path. Throws Unavailable with the places looked
  /// in where it cannot be loaded, InvalidArgument where it is no plugin or built for another
  /// version.
  void load_plugin(const std::string& name);

 private:
  void refuse_duplicate(const std::string& component) const;

  std::map<std::string, BodyFactory> bodies_;
  std::map<std::string, CspFactory> csps_;
  std::map<std::string, Mission> missions_;
};

}  // namespace skein
