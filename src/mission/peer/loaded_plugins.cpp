#include "loaded_plugins.hpp"

#include <algorithm>
#include <iterator>
#include <optional>
#include <string_view>
#include <utility>

#include "brokerless_discovery/versions.hpp"
#include "idl/types/type_text.hpp"

namespace skein::launch {
namespace {

using Held = LoadedPlugins::Held;

bool fit(const InterfaceInfo& one, const InterfaceInfo& other) {
  return brokerless_discovery::understands(one, other) ||
         brokerless_discovery::understands(other, one);
}

/// In the interface itself; where that is the same on both sides, in the types that it names.
std::optional<std::pair<std::string, std::string>> difference(const InterfaceInfo& one,
                                                              const InterfaceInfo& other) {
  const std::string first = idl::type_text(one);
  const std::string second = idl::type_text(other);
  const std::string opening = "interface " + std::string(one.name.substr(one.name.rfind('/') + 1));
  const auto interface_in = [&](const std::string& text) {
    return std::string_view(text).substr(std::min(text.find(opening), text.size()));
  };
  const auto found = idl::difference_of_texts(interface_in(first), interface_in(second));
  return found ? found : idl::difference_of_texts(first, second);
}

std::string told(const Held& one, const Held& other) {
  const auto differing = difference(*one.interface, *other.interface);
  return "the plugins '" + one.plugin + "' and '" + other.plugin + "' hold two versions of " +
         std::string(one.interface->name) + ", and neither calls what the other implements" +
         (differing ? ": " + differing->first + ", and " + differing->second : "");
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
