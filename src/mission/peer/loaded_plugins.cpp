#include "loaded_plugins.hpp"

#include <algorithm>
#include <iterator>

#include "brokerless_discovery/versions.hpp"
#include "core/system/interface_name.hpp"
#include "idl/types/type_difference.hpp"
#include "skein/describe.hpp"

namespace skein::launch {
namespace {

using Held = LoadedPlugins::Held;

bool fit(const InterfaceInfo& one, const InterfaceInfo& other) {
  return brokerless_discovery::understands(one, other) ||
         brokerless_discovery::understands(other, one);
}

std::string told(const Held& one, const Held& other) {
  const std::string name(one.interface->name);
  const auto differing = idl::difference_of_interfaces(
      scoped_interface_name(name), describe(*one.interface), describe(*other.interface));
  const auto in = [](const Held& held) { return "in '" + held.plugin + "'"; };
  return "the plugins '" + one.plugin + "' and '" + other.plugin + "' hold two versions of " +
         name + ", and neither calls what the other implements" +
         (differing ? ": " + idl::in_words(*differing, in(one), in(other)) : "");
}

}  // namespace

void LoadedPlugins::load(const std::string& plugin) {
  const bool known = std::ranges::count(loaded_, plugin, &Loaded::name) > 0;
  if (plugin.empty() || known) return;
  const auto before = registry_.names();
  registry_.load_plugin(plugin);
  Loaded& loaded = loaded_.emplace_back();
  loaded.name = plugin;
  std::ranges::set_difference(registry_.names(), before, std::back_inserter(loaded.components));
}

std::vector<std::string> LoadedPlugins::names_of(const std::string& plugin) const {
  const auto found = std::ranges::find(loaded_, plugin, &Loaded::name);
  return found == loaded_.end() ? std::vector<std::string>() : found->components;
}

std::vector<Held> LoadedPlugins::interfaces() const {
  std::vector<Held> held;
  for (const Loaded& plugin : loaded_) {
    for (const std::string& component : plugin.components) {
      if (const auto* interface = registry_.find_interface(component))
        held.push_back({plugin.name, interface});
    }
  }
  return held;
}

std::vector<std::string> add_versions(std::vector<Held>& known, const std::vector<Held>& more) {
  std::vector<std::string> texts;
  for (const Held& one : more) {
    const bool seen = std::ranges::any_of(known, [&](const Held& other) {
      return one.plugin == other.plugin && one.interface == other.interface;
    });
    if (seen) continue;
    for (const Held& other : known) {
      const bool same = one.plugin == other.plugin || one.interface->name != other.interface->name;
      if (same || fit(*other.interface, *one.interface)) continue;
      texts.push_back(told(other, one));
    }
    known.push_back(one);
  }
  return texts;
}

}  // namespace skein::launch
