#include "mission/profile/mission_profile.hpp"

#include <algorithm>

#include "mission/xml/words.hpp"
#include "value_file.hpp"

namespace skein::profile {
namespace {

template <typename Items>
auto find_item(Items& items, std::string_view name) {
  const auto found =
      std::find_if(items.begin(), items.end(), [&](const auto& item) { return item.name == name; });
  return found == items.end() ? nullptr : &*found;
}

template <typename Items>
std::vector<std::string_view> names_of(const Items& items) {
  std::vector<std::string_view> names;
  for (const auto& item : items) names.push_back(item.name);
  return names;
}

template <typename Items>
auto& demand_named(Items& items, std::string_view name, const std::string& kind) {
  if (auto* found = find_item(items, name)) return *found;
  throw InvalidArgument("there is no " + kind + " " + in_quotes(name) + "; " +
                        remedy_for(name, names_of(items)));
}

std::vector<std::string_view> parameters_of(const ComponentDescription& component) {
  std::vector<std::string_view> names;
  for (const Parameter* parameter : component.parameters()) names.push_back(parameter->name);
  return names;
}

/// The settings by which the peer's CSPs, or for a CSP nobody, take that parameter.
std::string settings_of_csps(const PeerProfile& peer, std::string_view name) {
  std::string settings;
  for (const CspProfile& csp : peer.csps) {
    if (!csp.component || std::ranges::count(parameters_of(*csp.component), name) == 0) continue;
    settings +=
        (settings.empty() ? "" : ", ") + peer.name + "/" + csp.name + "." + std::string(name);
  }
  return settings;
}
std::string settings_of_csps(const CspProfile&, std::string_view) { return {}; }

/// `owner`: a peer or a CSP, whose component that is.
template <typename Owner>
void demand_parameter(const Owner& owner, const ComponentDescription& component,
                      std::string_view name) {
  const auto known = parameters_of(component);
  if (known.empty() && component.interfaces.empty()) return;
  if (std::ranges::count(known, name) > 0) return;
  const std::string settings = settings_of_csps(owner, name);
  throw InvalidArgument(
      in_quotes(component.name) + " has no parameter " + in_quotes(name) + "; " +
      (settings.empty() ? remedy_for(name, known) : "what it chooses among has it: " + settings));
}

template <typename Owner>
void set_parameter(Owner& owner, const Dictionary& dictionary, const std::string& name,
                   const std::string& value) {
  if (owner.component) demand_parameter(owner, *owner.component, name);
  const auto* entry = dictionary.find(EntryKind::Parameter, name);
  if (entry == nullptr) {
    throw InvalidArgument("the dictionary has no parameter " + in_quotes(name) + "; " +
                          dictionary.suggestion(EntryKind::Parameter, name));
  }
  const SourcePosition where{"the command line", 0, 0};
  Setting given{name, with_whole_path(value, ""), where, where, ""};
  FindingList findings;
  read_value_file(given, findings);
  findings.throw_if_errors();
  parse_value(*entry, given.value);
  if (auto* setting = find_item(owner.parameters, name)) {
    given.where = setting->where;
    *setting = std::move(given);
  } else {
    owner.parameters.push_back(std::move(given));
  }
}

}  // namespace

const Setting* CspProfile::find_parameter(std::string_view parameter_name) const {
  return find_item(parameters, parameter_name);
}

const Setting* PeerProfile::find_parameter(std::string_view parameter_name) const {
  return find_item(parameters, parameter_name);
}

const CspProfile* PeerProfile::find_csp(std::string_view csp_name) const {
  return find_item(csps, csp_name);
}

const PeerProfile* MissionProfile::find_peer(std::string_view peer_name) const {
  return find_item(peers, peer_name);
}

VariableValues parse_variables(const std::vector<std::string>& assignments) {
  VariableValues values;
  for (const auto& assignment : assignments) {
    const auto equals = assignment.find('=');
    if (equals == 0 || equals == std::string::npos) {
      throw InvalidArgument(in_quotes(assignment) + " sets no variable; write NAME=VALUE");
    }
    values[assignment.substr(0, equals)] = assignment.substr(equals + 1);
  }
  return values;
}

void demand_setting(std::string_view assignment) {
  const auto equals = assignment.find('=');
  if (equals != std::string_view::npos && assignment.find('.') < equals) return;
  const std::string variable =
      equals == std::string_view::npos ? "" : "; a variable is set by --variable";
  throw InvalidArgument(in_quotes(assignment) +
                        " is no setting; write PEER.PARAMETER=VALUE or PEER/CSP.PARAMETER=VALUE" +
                        variable);
}

void apply_setting(MissionProfile& profile, std::string_view assignment) {
  demand_setting(assignment);
  const auto equals = assignment.find('=');
  const auto dot = assignment.find('.');
  const auto owner = assignment.substr(0, dot);
  const std::string parameter(assignment.substr(dot + 1, equals - dot - 1));
  const std::string value(assignment.substr(equals + 1));
  const auto slash = owner.find('/');
  auto& peer = demand_named(profile.peers, owner.substr(0, slash), "peer");
  if (slash == std::string_view::npos) {
    set_parameter(peer, profile.dictionary, parameter, value);
  } else {
    auto& csp = demand_named(peer.csps, owner.substr(slash + 1), "CSP");
    set_parameter(csp, profile.dictionary, parameter, value);
  }
}

}  // namespace skein::profile
