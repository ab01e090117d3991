#include "mission/check/profile_check.hpp"

#include <algorithm>
#include <cctype>
#include <map>
#include <set>
#include <utility>

#include "check_component.hpp"
#include "core/suggestion.hpp"
#include "dds/port/vendor_names.hpp"
#include "mission/profile/composition.hpp"
#include "mission/profile/repeated.hpp"
#include "mission/xml/finding_list.hpp"
#include "mission/xml/words.hpp"
#include "skein/selection.hpp"

namespace skein::profile {
namespace {

class Checker {
 public:
  explicit Checker(const MissionProfile& mission) : mission_(mission), composition_(mission) {}

  std::vector<Finding> run() {
    check_mission_peer();
    check_loopback();
    check_groups();
    check_files();
    check_topics();
    Repeated names("the peer");
    for (std::size_t i = 0; i < mission_.peers.size() && !findings_.full(); ++i) {
      names.add(mission_.peers[i].name, mission_.peers[i].where, findings_);
      check_peer(i);
    }
    check_cycles();
    return findings_.list();
  }

 private:
  void check_mission_peer() {
    const PeerProfile* first = nullptr;
    bool told = false;
    for (const auto& peer : mission_.peers) {
      if (!peer.runs_mission) continue;
      if (first != nullptr && peer.where == first->where) {
        if (std::exchange(told, true)) continue;  // one finding, however large its count
        findings_.error(peer.where, "role=\"mission\" with count: one peer runs the mission",
                        "leave count out, or the role");
        continue;
      }
      if (first != nullptr) {
        findings_.error(peer.where, "a second peer with role=\"mission\"",
                        "the first is at " + to_text(first->where));
      }
      if (first == nullptr) first = &peer;
      if (peer.component && !peer.component->interfaces.empty() && peer.start.program.empty()) {
        findings_.error(peer.where,
                        in_quotes(peer.name) + " has role=\"mission\" and provides " +
                            peer.component->interfaces.front().type +
                            ": a peer with a service runs until it is told to end",
                        "give the role to a peer whose component implements nothing");
      }
      if (peer.rules.restart.policy != RestartPolicy::Never) {
        findings_.error(peer.where,
                        in_quotes(peer.name) + " runs the mission and would be restarted",
                        "write restart=\"never\": its end is the mission's");
      }
    }
  }

  void check_loopback() {
    const bool one_process =
        mission_.peers.size() == 1 &&
        std::none_of(mission_.peers[0].csps.begin(), mission_.peers[0].csps.end(),
                     [](const CspProfile& csp) { return csp.process == CspProcess::Own; });
    if (one_process) return;
    for (const auto& peer : mission_.peers) {
      if (peer.vendor != dds::kLoopback || !peer.start.program.empty()) continue;
      findings_.error(peer.where,
                      in_quotes(peer.name) +
                          " is on loopback, a network inside of one process, and the mission has "
                          "more processes, which will not see it",
                      "write " + dds::alternatives(dds::networked_vendors()));
    }
  }

  /// They are chosen by name, as peers are.
  void check_groups() {
    for (const auto& peer : mission_.peers) {
      const auto* same = peer.group.empty() ? nullptr : mission_.find_peer(peer.group);
      if (same == nullptr) continue;
      findings_.error(same->where, in_quotes(same->name) + " is a peer's name and a group's",
                      "give one of them another");
    }
  }

  /// What is written to one file twice spoils it, whatever the ways to it are called. Without its
  /// folder it cannot be made: other hosts have others.
  void check_files() {
    Repeated files("the file of a history or decision_log");
    for (const auto& peer : mission_.peers) {
      const std::string host = peer.host == "localhost" ? "" : peer.host;
      for (const std::string& file : {peer.head.history, peer.head.log})
        files.add(std::filesystem::path(file).lexically_normal().string(), host, peer.where,
                  findings_);
      if (host.empty()) check_folders(peer);
    }
  }

  void check_folders(const PeerProfile& peer) {
    for (const std::string& file : {peer.head.history, peer.head.log}) {
      const std::filesystem::path folder = std::filesystem::path(file).parent_path();
      std::error_code ignored;
      if (folder.empty() || std::filesystem::is_directory(folder, ignored)) continue;
      findings_.error(
          peer.where,
          "the folder of the history or decision_log " + in_quotes(file) + " is not there",
          "make it, or start the mission where it is");
    }
  }

  /// Names are compared letter by letter. ROS writes a '/' in front, which is another topic here.
  void check_topics() {
    std::map<std::string, const TopicRules*> spelled;
    for (const auto& peer : mission_.peers) {
      for (const TopicRules& topic : peer.topics) {
        std::string plain = topic.name.substr(topic.name.starts_with('/') ? 1 : 0);
        std::ranges::transform(plain, plain.begin(),
                               [](unsigned char c) { return std::tolower(c); });
        const TopicRules* other = spelled.emplace(plain, &topic).first->second;
        if (other->name == topic.name || !told_topics_.insert(topic.name).second) continue;
        findings_.warning(
            topic.where,
            in_quotes(topic.name) + " and " + in_quotes(other->name) + " are two topics",
            "write one name everywhere; the other is at " + to_text(other->where));
      }
    }
  }

  void check_peer(std::size_t number) {
    const auto& peer = mission_.peers[number];
    check_needs(number);
    check_network(peer);
    check_strategy(peer);
    Repeated names("the CSP");
    for (const auto& csp : peer.csps) names.add(csp.name, csp.where, findings_);
    if (peer.component) {
      check_component(*peer.component, mission_.dictionary, findings_);
      if (peer.start.program.empty()) {
        check_settings(peer.name, peer.parameters, peer.where, *peer.component, mission_.dictionary,
                       findings_);
      }
      check_references(peer.parameters, peer);
      if (peer.start.program.empty()) check_subcomponents(peer);
    }
    for (const auto& csp : peer.csps) {
      if (!csp.component) continue;
      check_component(*csp.component, mission_.dictionary, findings_);
      if (csp.start.program.empty()) {
        check_settings(peer.name + "/" + csp.name, csp.parameters, csp.where, *csp.component,
                       mission_.dictionary, findings_);
      }
      check_references(csp.parameters, peer);
      check_isolation(csp);
      check_implements_something(csp);
    }
  }

  void check_implements_something(const CspProfile& csp) {
    if (!csp.component->interfaces.empty() || !csp.component->complete) return;
    findings_.error(csp.where,
                    "the CSP " + in_quotes(csp.name) + " implements no interface (" +
                        to_text(csp.component->where) + ")",
                    "add what it implements to <interfaces> there; an activity is a <peer>");
  }

  void check_network(const PeerProfile& peer) {
    if (!peer.interface.empty() || (peer.peers.empty() && !peer.multicast)) return;
    findings_.error(peer.where,
                    in_quotes(peer.name) + " is to look for peers of other hosts, but speaks on " +
                        "127.0.0.1 alone",
                    "name its network interface: interface=\"...\"");
  }

  void check_strategy(const PeerProfile& peer) {
    const bool has_plugin =
        !peer.plugin.empty() ||
        std::any_of(peer.csps.begin(), peer.csps.end(), [](const CspProfile& csp) {
          return csp.process == CspProcess::InOwner && !csp.plugin.empty();
        });
    if (has_plugin) return;  // what it holds only a machine can tell
    const auto known = StrategyFactory().names();
    if (std::find(known.begin(), known.end(), peer.head.strategy) != known.end()) return;
    findings_.warning(peer.where,
                      in_quotes(peer.head.strategy) +
                          " is none of Skein's own selection strategies, and " +
                          in_quotes(peer.name) + " has no plugin that could hold it",
                      remedy_for(peer.head.strategy, {known.begin(), known.end()}));
  }

  void check_isolation(const CspProfile& csp) {
    if (csp.process == CspProcess::Own) return;
    for (const auto& item : csp.component->interfaces) {
      for (const auto& attribute : item.attributes) {
        if (attribute.name != "isolated" || attribute.value != "true") continue;
        findings_.error(csp.where,
                        "the CSP " + in_quotes(csp.name) +
                            " works in its entity's process, but is " + "isolated (" +
                            to_text(attribute.where) + ")",
                        "write process=\"own\": what it may do to its process, it does alone");
      }
    }
  }

  void check_needs(std::size_t number) {
    const auto& peer = mission_.peers[number];
    for (const auto& need : composition_.needs(number)) {
      if (findings_.full()) return;
      if (!composition_.providers(need.interface).empty()) {
        note_other_systems(peer, need);
        continue;
      }
      if (some_incomplete()) continue;  // that may be the provider, and has a finding of its own
      const std::string who =
          need.csp.empty() ? in_quotes(peer.name) : in_quotes(peer.name + "/" + need.csp);
      const std::string csp = composition_.csp_with(need.interface);
      if (csp.empty()) {
        findings_.error(need.where,
                        who + " depends on " + need.interface + ", which no peer of " +
                            in_quotes(mission_.name) + " implements",
                        "add a peer that does" + unless_unread() + "; " +
                            remedy_for(need.interface, composition_.public_interfaces()));
      } else {
        findings_.error(need.where,
                        who + " depends on " + need.interface + ", which only the CSP " +
                            in_quotes(csp) + " implements",
                        "a CSP serves its own peer alone; depend on that peer's interface");
      }
    }
  }

  /// Code that connects without naming a system looks in its own.
  void note_other_systems(const PeerProfile& peer, const Need& need) {
    const auto& providers = composition_.providers(need.interface);
    const bool near = std::any_of(providers.begin(), providers.end(), [&](std::size_t provider) {
      return mission_.peers[provider].system == peer.system;
    });
    if (near) return;
    const PeerProfile& first = mission_.peers[providers.front()];
    findings_.add({Severity::Note, need.where,
                   in_quotes(peer.name) + " of system " + in_quotes(peer.system) + " depends on " +
                       need.interface + ", which is provided in other systems only, as by " +
                       in_quotes(first.name) + " of " + in_quotes(first.system),
                   "its code finds that if it names the system or kAnySystem; otherwise give both "
                   "peers one system"});
  }

  bool some_incomplete() const {
    return std::any_of(mission_.peers.begin(), mission_.peers.end(), [](const PeerProfile& peer) {
      return peer.component && !peer.component->complete;
    });
  }

  std::string unless_unread() const {
    const bool unread = std::any_of(
        mission_.peers.begin(), mission_.peers.end(),
        [](const PeerProfile& peer) { return !peer.component && peer.start.program.empty(); });
    return unread ? ", unless one whose component cannot be read does" : "";
  }

  static bool implements(const CspProfile& csp, const std::string& interface) {
    const auto& items = csp.component->interfaces;
    return std::any_of(items.begin(), items.end(),
                       [&](const ImplementedInterface& item) { return item.type == interface; });
  }

  /// Whether a subcomponent that no CSP implements has almost the name of an interface that one
  /// does: a finding of its own, in place of one for each CSP.
  bool misspelt_subcomponents(const PeerProfile& peer) {
    std::vector<std::string> offered;
    for (const auto& csp : peer.csps) {
      if (!csp.component) continue;
      for (const auto& item : csp.component->interfaces) offered.push_back(item.type);
    }
    bool any = false;
    for (const auto& item : peer.component->subcomponents) {
      const std::string near = suggestion(item.type, offered);
      if (near.empty() || std::ranges::count(offered, item.type) > 0) continue;
      any = true;
      findings_.error(item.where,
                      in_quotes(peer.component->name) + " has the subcomponent " + item.type +
                          ", which no CSP of " + in_quotes(peer.name) + " implements",
                      remedy_for(item.type, {offered.begin(), offered.end()}));
    }
    return any;
  }

  void check_subcomponents(const PeerProfile& peer) {
    const auto& wanted = peer.component->subcomponents;
    if (misspelt_subcomponents(peer)) return;
    const bool all_read = std::all_of(
        peer.csps.begin(), peer.csps.end(),
        [](const CspProfile& csp) { return csp.component && !csp.component->interfaces.empty(); });
    for (const auto& item : wanted) {
      const bool found = std::any_of(peer.csps.begin(), peer.csps.end(), [&](const auto& csp) {
        return csp.component && implements(csp, item.type);
      });
      if (found || !all_read) continue;
      findings_.error(peer.where,
                      in_quotes(peer.name) + " has no CSP for its subcomponent " + item.type +
                          " (" + to_text(item.where) + ")",
                      "add a <csp> whose component implements it");
    }
    for (const auto& csp : peer.csps) {
      const bool fits = !csp.component || csp.component->interfaces.empty() ||
                        std::any_of(wanted.begin(), wanted.end(),
                                    [&](const auto& item) { return implements(csp, item.type); });
      if (fits) continue;
      std::vector<std::string_view> known;
      for (const auto& item : wanted) known.push_back(item.type);
      findings_.error(csp.where,
                      "the CSP " + in_quotes(csp.name) + " implements no subcomponent of " +
                          in_quotes(peer.name),
                      known.empty() ? in_quotes(peer.component->name) + " has no subcomponents"
                                    : "it must implement one of them: " +
                                          remedy_for(csp.component->interfaces.empty()
                                                         ? ""
                                                         : csp.component->interfaces[0].type,
                                                     known));
    }
  }

  /// A service reference names an interface, a peer, or a CSP of the same peer.
  void check_references(const std::vector<Setting>& settings, const PeerProfile& peer) {
    for (const auto& setting : settings) {
      const auto* entry = mission_.dictionary.find(EntryKind::Parameter, setting.name);
      if (entry == nullptr || entry->type != ValueType::Service || setting.value.empty()) continue;
      const auto known = referable_names(peer, entry->interface);
      if (std::find(known.begin(), known.end(), setting.value) != known.end()) continue;
      findings_.error(setting.where,
                      in_quotes(setting.name) + " refers to " + in_quotes(setting.value) +
                          ", which is no peer or CSP with " +
                          (entry->interface.empty() ? "a service" : entry->interface),
                      remedy_for(setting.value, known));
    }
  }

  std::vector<std::string_view> referable_names(const PeerProfile& peer,
                                                const std::string& interface) const {
    const auto fits = [&](const ComponentDescription* component) {
      if (component == nullptr) return true;
      if (interface.empty()) return !component->interfaces.empty();
      return component->find_interface(interface) != nullptr;
    };
    std::vector<std::string_view> names;
    for (const auto& csp : peer.csps) {
      if (fits(csp.component.get())) names.push_back(csp.name);
    }
    for (const auto& other : mission_.peers) {
      if (fits(other.component.get())) names.push_back(other.name);
    }
    return names;
  }

  void check_cycles() {
    for (const auto& cycle : dependency_cycles(composition_)) {
      std::string way;
      for (const std::size_t peer : cycle) way += mission_.peers[peer].name + " -> ";
      way += mission_.peers[cycle.front()].name;
      findings_.error(place_of_cycle(cycle), "a cycle of dependencies: " + shortened(way),
                      "remove one of them, or add a provider outside of the cycle");
    }
  }

  /// The dependency that leads from the first peer of the cycle to the next one.
  SourcePosition place_of_cycle(const std::vector<std::size_t>& cycle) const {
    const std::size_t next = cycle.size() > 1 ? cycle[1] : cycle[0];
    for (const auto& need : composition_.needs(cycle[0])) {
      const auto& providers = composition_.providers(need.interface);
      if (std::find(providers.begin(), providers.end(), next) != providers.end()) return need.where;
    }
    return mission_.peers[cycle[0]].where;
  }

  const MissionProfile& mission_;
  Composition composition_;
  FindingList findings_;
  std::set<std::string> told_topics_;
};

}  // namespace

std::vector<Finding> check(const MissionProfile& profile) { return Checker(profile).run(); }

MissionProfile read_and_check(const std::filesystem::path& file, std::vector<Finding>& findings,
                              const VariableValues& values,
                              const std::vector<std::string>& settings, const std::string* text) {
  FindingList list;
  std::vector<Finding> of_reading;
  auto profile = read_mission_profile(file, of_reading, values, text);
  if (!has_errors(of_reading)) {
    for (const std::string& setting : settings) apply_setting(profile, setting);
  }
  list.add_all(of_reading);
  list.add_all(check(profile));
  findings.insert(findings.end(), list.list().begin(), list.list().end());
  return profile;
}

std::vector<Finding> check_file(const std::filesystem::path& file, const VariableValues& values) {
  std::vector<Finding> findings;
  read_and_check(file, findings, values);
  return findings;
}

MissionProfile read_checked_profile(const std::filesystem::path& file, const VariableValues& values,
                                    const std::vector<std::string>& settings) {
  std::vector<Finding> findings;
  auto profile = read_and_check(file, findings, values, settings);
  if (has_errors(findings)) throw DescriptionError(std::move(findings));
  return profile;
}

}  // namespace skein::profile
