#include "component_code.hpp"

#include <algorithm>
#include <array>
#include <utility>
#include <vector>

#include "core/printable.hpp"
#include "core/suggestion.hpp"

namespace skein::launch {
namespace {

constexpr std::size_t kLongestObjection = 1024;

/// How a plugin registers a component.
enum class Role { Body, Csp, Mission, Activity };

struct KindWords {
  const char* name;
  const char* registered_by;
};

KindWords words_for(Role kind) {
  switch (kind) {
    case Role::Body:
      return {"component", "add_body"};
    case Role::Csp:
      return {"CSP", "add_csp"};
    case Role::Mission:
      return {"mission", "add_mission"};
    case Role::Activity:
      break;
  }
  return {"activity", "add_activity"};
}

std::optional<Role> kind_of(const std::string& component, const ComponentRegistry& registry) {
  if (registry.find_body(component)) return Role::Body;
  if (registry.find_csp(component)) return Role::Csp;
  if (registry.find_mission(component)) return Role::Mission;
  if (registry.find_activity(component)) return Role::Activity;
  return std::nullopt;
}

/// For a component that is registered, but as `found` where it has to be `wanted`.
const char* remedy_for(Role wanted, Role found) {
  if (found == Role::Csp)
    return "write it as a <csp> of the peer that uses it, or name another component";
  if (wanted == Role::Csp) return "register it by add_csp";
  if (found == Role::Body) return "add what it implements to <interfaces> in its description";
  if (found == Role::Mission && wanted == Role::Activity)
    return "write role=\"mission\", or register it by add_activity, so that it can be told to end";
  return "register what it provides by add_body, or remove <implements> from its description";
}

/// Where none of the loaded plugins has the component.
CodeLack missing(const std::string& who, const std::string& component, const std::string& plugin,
                 const LoadedPlugins& plugins) {
  if (plugin.empty()) {
    return {"no plugin is named for the " + who, "name the one that implements it: plugin=\"...\""};
  }
  const auto own = plugins.names_of(plugin);
  if (own.empty()) {
    return {
        "the plugin '" + plugin + "' registers no component at all, and is to implement the " + who,
        "register it in the plugin's skein_register_components"};
  }
  std::string names;
  for (const std::string& name : own) names += (names.empty() ? "" : ", ") + name;
  return {"the plugin '" + plugin + "' has no implementation of the " + who +
              suggestion(component, own),
          "it implements " + names};
}

/// `wanted`: any of these will do; the first is the one that messages name.
std::optional<CodeLack> find_lack(const std::string& component, const std::vector<Role>& wanted,
                                  const std::string& plugin, const LoadedPlugins& plugins) {
  const auto found = kind_of(component, plugins.registry());
  if (found && std::ranges::count(wanted, *found) > 0) return std::nullopt;
  const KindWords words = words_for(wanted.front());
  const std::string who = std::string(words.name) + " '" + component + "'";
  if (!found) return missing(who, component, plugin, plugins);
  return CodeLack{"no code would run for the " + who + ": it is registered by " +
                      words_for(*found).registered_by + ", not by " + words.registered_by,
                  remedy_for(wanted.front(), *found)};
}

std::vector<Role> wanted_of(const profile::PeerProfile& peer) {
  if (!peer.component->interfaces.empty()) return {Role::Body};
  if (peer.runs_mission) return {Role::Mission, Role::Activity};
  return {Role::Activity};
}

/// Why a check refuses the value; nothing if it passes, or is none by the dictionary.
std::optional<std::string> objection(const profile::DictionaryEntry& entry, std::string_view text,
                                     const ComponentRegistry& registry) {
  ParameterValue value;
  try {
    value = profile::parse_value(entry, text);
  } catch (const InvalidArgument&) {
    return std::nullopt;
  }
  try {
    registry.check_value(entry.name, value);
  } catch (const std::exception& error) {
    return printable(error.what(), kLongestObjection);
  }
  return std::nullopt;
}

/// The line of a file that is refused for that reason by itself, from 1; 0 if none is.
int find_line(const profile::DictionaryEntry& entry, std::string_view text,
              const std::string& reason, const ComponentRegistry& registry) {
  for (int line = 1; !text.empty(); ++line) {
    const std::size_t length = std::min(text.find('\n'), text.size());
    if (objection(entry, text.substr(0, length), registry) == reason) return line;
    text.remove_prefix(std::min(length + 1, text.size()));
  }
  return 0;
}

}  // namespace

std::optional<CodeLack> find_lack(const profile::PeerProfile& peer, const LoadedPlugins& plugins) {
  return find_lack(peer.component->name, wanted_of(peer), peer.plugin, plugins);
}

std::optional<CodeLack> find_lack(const profile::CspProfile& csp, const LoadedPlugins& plugins) {
  return find_lack(csp.component->name, {Role::Csp}, csp.plugin, plugins);
}

std::vector<profile::Finding> compare(const profile::ComponentDescription& component,
                                      const InterfaceInfo& code) {
  std::vector<profile::Finding> findings;
  std::vector<std::string> provided{std::string(code.name)};
  for (const InterfaceInfo* base : code.bases) provided.emplace_back(base->name);
  for (const auto& declared : component.interfaces) {
    if (std::ranges::count(provided, declared.type) > 0) continue;
    findings.push_back({profile::Severity::Error, declared.where,
                        "'" + component.name + "' declares " + declared.type +
                            ", which its code does not implement" +
                            suggestion(declared.type, provided),
                        "its code implements " + provided.front()});
  }
  if (findings.empty() && !component.find_interface(code.name)) {
    findings.push_back({profile::Severity::Error, component.where,
                        "'" + component.name + "' does not declare " + provided.front() +
                            ", which its code implements",
                        "write <implements>IDL:" + provided.front() + "</implements>"});
  }
  return findings;
}

std::vector<profile::Finding> find_wrong_values(const std::vector<profile::Setting>& settings,
                                                const profile::Dictionary& dictionary,
                                                const ComponentRegistry& registry) {
  std::vector<profile::Finding> findings;
  for (const profile::Setting& setting : settings) {
    const auto* entry = dictionary.find(profile::EntryKind::Parameter, setting.name);
    const auto reason = entry ? objection(*entry, setting.value, registry) : std::nullopt;
    if (!reason) continue;
    profile::SourcePosition place = setting.value_where;
    if (!setting.file.empty()) {
      place.line = find_line(*entry, setting.value, *reason, registry);
      place.column = place.line > 0 ? 1 : 0;
    }
    findings.push_back({profile::Severity::Error, place, "\"" + setting.name + "\": " + *reason,
                        "it is defined at " + to_text(entry->where)});
  }
  return findings;
}

}  // namespace skein::launch
