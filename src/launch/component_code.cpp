#include "component_code.hpp"

#include <algorithm>
#include <array>
#include <utility>
#include <vector>

#include "core/suggestion.hpp"

namespace skein::launch {
namespace {

/// How a plugin registers a component.
enum class Kind { Body, Csp, Mission, Activity };

struct KindWords {
  const char* name;
  const char* registered_by;
};

KindWords words_for(Kind kind) {
  switch (kind) {
    case Kind::Body:
      return {"component", "add_body"};
    case Kind::Csp:
      return {"CSP", "add_csp"};
    case Kind::Mission:
      return {"mission", "add_mission"};
    case Kind::Activity:
      break;
  }
  return {"activity", "add_activity"};
}

std::optional<Kind> kind_of(const std::string& component, const ComponentRegistry& registry) {
  if (registry.find_body(component)) return Kind::Body;
  if (registry.find_csp(component)) return Kind::Csp;
  if (registry.find_mission(component)) return Kind::Mission;
  if (registry.find_activity(component)) return Kind::Activity;
  return std::nullopt;
}

/// For a component that is registered, but as `found` where it has to be `wanted`.
const char* remedy_for(Kind wanted, Kind found) {
  if (found == Kind::Csp)
    return "write it as a <csp> of the peer that uses it, or name another component";
  if (wanted == Kind::Csp) return "register it by add_csp";
  if (found == Kind::Body) return "add what it implements to <interfaces> in its description";
  if (found == Kind::Mission && wanted == Kind::Activity)
    return "write role=\"mission\", or register it by add_activity, so that it can be told to end";
  return "register what it provides by add_body, or remove <implements> from its description";
}

/// `wanted`: any of these will do; the first is the one that messages name.
std::optional<CodeLack> find_lack(const std::string& component, const std::vector<Kind>& wanted,
                                  const std::string& plugin, const ComponentRegistry& registry) {
  const auto found = kind_of(component, registry);
  if (found && std::ranges::count(wanted, *found) > 0) return std::nullopt;
  const KindWords words = words_for(wanted.front());
  const std::string who = std::string(words.name) + " '" + component + "'";
  if (found) {
    return CodeLack{"no code would run for the " + who + ": it is registered by " +
                        words_for(*found).registered_by + ", not by " + words.registered_by,
                    remedy_for(wanted.front(), *found)};
  }
  if (plugin.empty()) {
    return CodeLack{"no plugin is named for the " + who,
                    "name the one that implements it: plugin=\"...\""};
  }
  const auto known = registry.names();
  std::string names;
  for (const std::string& name : known) names += (names.empty() ? "" : ", ") + name;
  return CodeLack{"the plugin '" + plugin + "' has no implementation of the " + who +
                      suggestion(component, known),
                  names.empty() ? "it has none at all" : "it implements " + names};
}

std::vector<Kind> wanted_of(const profile::PeerProfile& peer) {
  if (!peer.component->interfaces.empty()) return {Kind::Body};
  if (peer.runs_mission) return {Kind::Mission, Kind::Activity};
  return {Kind::Activity};
}

}  // namespace

std::optional<CodeLack> find_lack(const profile::PeerProfile& peer,
                                  const ComponentRegistry& registry) {
  return find_lack(peer.component->name, wanted_of(peer), peer.plugin, registry);
}

std::optional<CodeLack> find_lack(const profile::CspProfile& csp,
                                  const ComponentRegistry& registry) {
  return find_lack(csp.component->name, {Kind::Csp}, csp.plugin, registry);
}

}  // namespace skein::launch
