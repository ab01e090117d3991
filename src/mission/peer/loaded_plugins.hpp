#pragma once

#include <string>
#include <vector>

#include "skein/component_registry.hpp"

namespace skein::launch {

/// The plugins of a process, and which of them has registered what.
class LoadedPlugins {
 public:
  /// `registry` outlives this object; what it holds already is of the program.
  explicit LoadedPlugins(ComponentRegistry& registry) : registry_(registry) {}

  /// Loads the plugin as ComponentRegistry::load_plugin() does; does nothing for an empty name, and
  /// for one that has been loaded.
  void load(const std::string& plugin);

  const ComponentRegistry& registry() const noexcept { return registry_; }
  /// Of the components that this plugin has registered, sorted.
  std::vector<std::string> names_of(const std::string& plugin) const;

  /// An interface that a component of the plugin implements.
  struct Held {
    std::string plugin;
    const InterfaceInfo* interface;
  };
  std::vector<Held> interfaces() const;

 private:
  struct Loaded {
    std::string name;
    std::vector<std::string> components;
  };
  ComponentRegistry& registry_;
  std::vector<Loaded> loaded_;
};

/// Adds to `known` what `more` holds. What is to be told of each two plugins that hold versions of
/// one interface of which neither understands the other: `the plugins 'a' and 'b' hold ...`.
std::vector<std::string> add_versions(std::vector<LoadedPlugins::Held>& known,
                                      const std::vector<LoadedPlugins::Held>& more);

}  // namespace skein::launch
