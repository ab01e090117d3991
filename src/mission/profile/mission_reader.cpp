#include <algorithm>
#include <charconv>
#include <sstream>

#include "brokerless_discovery/admission.hpp"
#include "dds/port/allowed_sources.hpp"
#include "dds/port/vendor_names.hpp"
#include "head_reader.hpp"
#include "mission/component/component_cache.hpp"
#include "mission/component/dictionary_reader.hpp"
#include "mission/profile/mission_profile.hpp"
#include "mission/xml/notation.hpp"
#include "mission/xml/text_file.hpp"
#include "mission/xml/words.hpp"
#include "peer_defaults.hpp"
#include "plain_name.hpp"
#include "process_start_reader.hpp"
#include "profile_parts.hpp"
#include "rules_reader.hpp"
#include "skein/error.hpp"
#include "thread_rules_reader.hpp"
#include "topic_rules_reader.hpp"
#include "value_file.hpp"
#include "value_readers.hpp"

namespace skein::profile {
namespace {

constexpr int kLargestDomain = 232;
constexpr std::size_t kMaxHosts = 64;

class MissionReader {
 public:
  MissionReader(const std::filesystem::path& file, FindingList& findings)
      : file_(file), findings_(findings), components_(findings) {}

  MissionProfile read(const XmlElement& root) {
    MissionProfile mission;
    mission.file = file_;
    mission.where = root.where();
    mission.name = root.attribute("name").value;
    mission.domain = domain_of(root);
    if (root.maybe_attribute("logs")) mission.logs = root.attribute("logs").value;
    mission.dictionary = dictionary_of(root, mission.files);
    for (const auto& child : root.children("peer")) mission.peers.push_back(peer_of(child));
    if (mission.peers.empty()) findings_.error(root.where(), "the mission has no <peer>");
    mission.files.insert(file_);
    mission.files.merge(components_.files());
    mission.files.merge(value_files_);
    return mission;
  }

 private:
  int domain_of(const XmlElement& root) {
    const auto text = root.maybe_attribute("domain");
    if (!text) return 0;
    int domain = -1;
    const auto end = text->value.data() + text->value.size();
    const auto result = std::from_chars(text->value.data(), end, domain);
    if (result.ec != std::errc() || result.ptr != end || domain < 0 || domain > kLargestDomain) {
      findings_.error(text->where, in_quotes(text->value) + " is no DDS domain",
                      "write a number from 0 to " + std::to_string(kLargestDomain));
      return 0;
    }
    return domain;
  }

  Dictionary dictionary_of(const XmlElement& root, std::set<std::filesystem::path>& files) {
    const auto named = root.maybe_attribute("dictionary");
    const auto path = file_.parent_path() / (named ? named->value : "dictionary.xml");
    std::error_code ignored;
    if (!named && !std::filesystem::exists(std::filesystem::symlink_status(path, ignored)))
      return {};
    try {
      const auto text = read_text_file(path);
      files.insert(path.lexically_normal());
      return read_dictionary(parse_xml(text, path.string(), findings_), findings_);
    } catch (const DescriptionError& error) {
      findings_.error(named ? named->where : root.where(), "the dictionary cannot be read",
                      "name its file, relative to the profile: dictionary=\"...\"");
      findings_.add_all(error.findings());
      return Dictionary::unread();
    }
  }

  static std::string value_or(const XmlElement& element, const char* name,
                              const std::string& fallback) {
    const auto attribute = element.maybe_attribute(name);
    return attribute ? attribute->value : fallback;
  }

  std::string vendor_of(const XmlElement& element, std::string fallback) {
    const auto vendor = element.maybe_attribute("vendor");
    if (!vendor) return fallback;
    const auto& known = dds::vendor_names();
    if (std::find(known.begin(), known.end(), vendor->value) == known.end()) {
      findings_.error(vendor->where, in_quotes(vendor->value) + " is no DDS vendor known here",
                      remedy_for(vendor->value, {known.begin(), known.end()}));
    }
    return vendor->value;
  }

  static std::optional<bool> shared_memory_calls_of(const XmlElement& element,
                                                    std::optional<bool> fallback) {
    constexpr const char* kName = "shared_memory_calls";
    if (!element.maybe_attribute(kName)) return fallback;
    return read_boolean(element, kName, true);
  }

  bool shared_memory_of(const XmlElement& element, const std::string& vendor, bool fallback) {
    const bool wanted = read_boolean(element, "shared_memory", fallback);
    const auto attribute = element.maybe_attribute("shared_memory");
    const auto& able = dds::shared_memory_vendors();
    if (!wanted || std::find(able.begin(), able.end(), vendor) != able.end()) return wanted;
    if (attribute) {
      findings_.error(
          attribute->where, in_quotes(vendor) + " has no shared memory",
          "leave shared_memory out, or write vendor=" + in_quotes(dds::alternatives(able)));
    }
    return false;
  }

  std::vector<std::string> allowed_sources_of(const XmlElement& element) {
    const auto attribute = element.maybe_attribute("allowed_sources");
    if (!attribute) return {};
    std::vector<std::string> sources;
    std::istringstream words(attribute->value);
    for (std::string word; words >> word;) sources.push_back(word);
    try {
      if (sources.empty()) throw InvalidArgument("allowed_sources names none");
      (void)dds::AllowedSources(sources);
    } catch (const InvalidArgument& error) {
      findings_.error(attribute->where, error.what(),
                      "separate several by spaces; without the attribute all are allowed");
    }
    return sources;
  }

  /// Names or addresses, separated by blanks or commas.
  std::vector<std::string> hosts_of(const XmlElement& element) {
    const auto list = element.maybe_attribute("peers");
    if (!list) return {};
    std::vector<std::string> hosts;
    for (std::string_view rest = list->value; !(rest = trimmed(rest)).empty();) {
      const std::size_t end = std::min(rest.find_first_of(", \t\r\n"), rest.size());
      hosts.emplace_back(rest.substr(0, end));
      rest.remove_prefix(std::min(end + 1, rest.size()));
      const bool plain = !hosts.back().empty() &&
                         std::all_of(hosts.back().begin(), hosts.back().end(), [](char c) {
                           return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') ||
                                  (c >= '0' && c <= '9') || c == '.' || c == '-' || c == '_';
                         });
      if (plain && hosts.size() <= kMaxHosts) continue;
      findings_.error(list->where, "peers is " + in_quotes(list->value) + ", no list of hosts",
                      "write names or addresses, as in \"10.0.0.2 10.0.0.3\", at most " +
                          std::to_string(kMaxHosts));
      return {};
    }
    return hosts;
  }

  /// What a file's name at that place is relative to: for one of the command line, here.
  static std::filesystem::path folder_of(const SourcePosition& place) {
    return place.line == 0 ? "" : std::filesystem::path(place.file).parent_path();
  }

  std::vector<Setting> parameters_of(const XmlElement& element) {
    std::vector<Setting> settings;
    for (const auto& child : element.children("parameter")) {
      const XmlAttribute value = child.attribute("value");
      const SourcePosition place = value.given_by.value_or(child.where());
      Setting& setting = settings.emplace_back();
      setting = {child.attribute("name").value, with_whole_path(value.value, folder_of(place)),
                 child.where(), place, ""};
      read_value_file(setting, findings_);
      if (!setting.file.empty()) value_files_.insert(setting.file);
    }
    return settings;
  }

  PeerProfile peer_of(const XmlElement& element) {
    PeerProfile peer;
    peer.where = element.where();
    peer.name = name_of(element, "name");
    if (element.maybe_attribute(kGroupAttribute)) peer.group = name_of(element, kGroupAttribute);
    peer.start = read_process_start(element);
    if (!peer.start.program.empty()) refuse_peer_options(element);
    read_component_of(element, peer);
    peer.vendor = vendor_of(element, dds::vendor_names().front());
    peer.system = system_of(element);
    peer.host = value_or(element, "host", "");
    peer.interface = value_or(element, "interface", "");
    peer.peers = hosts_of(element);
    peer.multicast = read_boolean(element, "multicast", false);
    peer.allowed_sources = allowed_sources_of(element);
    peer.shared_memory = shared_memory_of(element, peer.vendor, false);
    peer.shared_memory_calls = shared_memory_calls_of(element, std::nullopt);
    peer.plugin = value_or(element, "plugin", "");
    peer.runs_mission = runs_mission(element);
    peer.rules = read_process_rules(element, LossPolicy::Abort);
    if (peer.runs_mission) refuse_loss_policy(element);
    peer.threads = read_thread_rules(element);
    peer.head = read_head_options(element);
    peer.topics = read_topic_rules(element);
    peer.parameters = parameters_of(element);
    for (const auto& child : element.children("csp")) peer.csps.push_back(csp_of(child, peer));
    const bool chooses = !peer.csps.empty() || !peer.component ||
                         !peer.component->subcomponents.empty();  // it lacks their CSPs
    if (!chooses) warn_of_head_without_csps(element);
    return peer;
  }

  std::string system_of(const XmlElement& element) {
    const auto system = element.maybe_attribute("system");
    if (!system) return "default";
    if (!brokerless_discovery::is_name(system->value)) {
      findings_.error(system->where, in_quotes(system->value) + " is no name of a system",
                      "use letters, digits, '_', '-' and '.', 255 at most");
    }
    return system->value;
  }

  void read_component_of(const XmlElement& element, PeerProfile& peer) {
    const bool has_program = element.has_attribute("program");
    if (!has_program && !element.has_attribute("component")) {
      findings_.error(element.where(), "<peer> has neither a component nor a program",
                      "write component=\"...\", or program=\"...\"");
    } else if (!has_program || element.has_attribute("component")) {
      const auto component = element.attribute("component");
      peer.component_file = component.value;
      peer.component = components_.read(component);
    }
  }

  std::string name_of(const XmlElement& element, const char* attribute) {
    const auto name = element.attribute(attribute);
    demand_plain_name(name, findings_);
    return name.value;
  }

  bool runs_mission(const XmlElement& peer) {
    const auto role = peer.maybe_attribute("role");
    if (!role) return false;
    if (role->value != "mission") {
      findings_.error(role->where, in_quotes(role->value) + " is no role",
                      "the one role is \"mission\": the end of this peer ends the mission");
    }
    return role->value == "mission";
  }

  void refuse_loss_policy(const XmlElement& peer) {
    const auto policy = peer.maybe_attribute("on_loss");
    if (!policy || policy->inherited) return;
    findings_.error(policy->where, "on_loss has no effect on the peer with role=\"mission\"",
                    "remove it: the end of this peer ends the mission");
  }

  CspProfile csp_of(const XmlElement& element, const PeerProfile& peer) {
    CspProfile csp;
    csp.where = element.where();
    const auto component = element.attribute("component");
    csp.component_file = component.value;
    csp.component = components_.read(component);
    if (element.maybe_attribute("name")) {
      csp.name = name_of(element, "name");
    } else if (csp.component) {
      csp.name = csp.component->name;
      demand_plain_name({"name", csp.name, element.where()}, findings_);
    }
    csp.process = process_of(element);
    csp.vendor = vendor_of(element, peer.vendor);
    csp.shared_memory = shared_memory_of(element, csp.vendor, peer.shared_memory);
    csp.shared_memory_calls = shared_memory_calls_of(element, peer.shared_memory_calls);
    csp.plugin = value_or(element, "plugin", peer.plugin);
    csp.rules = read_process_rules(element, LossPolicy::Continue);
    csp.threads = read_thread_rules(element);
    csp.parameters = parameters_of(element);
    csp.start = read_process_start(element);
    add_environment(peer.start.environment, csp.start);
    if (csp.process == CspProcess::InOwner) {
      refuse_process_rules(element);
      refuse_process_start(element);
    } else if (!csp.start.program.empty()) {
      refuse_peer_options(element);
    }
    if (csp.process == CspProcess::Own && csp.threads.thread == CallThread::Caller) {
      findings_.error(element.maybe_attribute("thread")->where,
                      "a CSP in a process of its own cannot run on its caller's thread",
                      "leave thread out, or write process=\"in\"");
    }
    return csp;
  }

  /// What the CSP does not say itself.
  static void add_environment(const std::vector<std::pair<std::string, std::string>>& of_peer,
                              ProcessStart& start) {
    const auto own = start.environment;
    for (const auto& item : of_peer) {
      const bool known = std::any_of(own.begin(), own.end(),
                                     [&](const auto& mine) { return mine.first == item.first; });
      if (!known) start.environment.push_back(item);
    }
  }

  CspProcess process_of(const XmlElement& csp) {
    const auto process = csp.maybe_attribute("process");
    if (!process || process->value == "in") return CspProcess::InOwner;
    if (process->value != "own") {
      findings_.error(process->where, in_quotes(process->value) + " is no place for a CSP",
                      "write \"in\" (the entity's process) or \"own\" (a process of its own)");
    }
    return CspProcess::Own;
  }

  std::filesystem::path file_;
  FindingList& findings_;
  ComponentCache components_;
  std::set<std::filesystem::path> value_files_;
};

/// What the file holds, or will hold if there is a text.
MissionProfile read_mission(const std::filesystem::path& file, const VariableValues& values,
                            FindingList& findings, const std::string* text = nullptr) {
  try {
    XmlNode root = parse_xml(text ? *text : read_text_file(file), file.string(), findings);
    if (root.name != mission_notation().name) {
      findings.error(root.where, "<" + shortened(root.name) + "> is no mission profile",
                     "its outermost element is <mission name=\"...\">");
      return {};
    }
    Variables variables(values);
    auto parts = put_parts_in_place(root, variables, findings);
    variables.demand_known(file.string(), findings);
    demand_notation(root, mission_notation(), findings);
    complete_peers(root, variables, findings);
    auto mission = MissionReader(file, findings).read(XmlElement(root, findings));
    mission.files.merge(parts);
    return mission;
  } catch (const DescriptionError& error) {
    findings.add_all(error.findings());
    return {};
  }
}

}  // namespace

MissionProfile read_mission_profile(const std::filesystem::path& file,
                                    std::vector<Finding>& findings, const VariableValues& values,
                                    const std::string* text) {
  FindingList list;
  auto mission = read_mission(file, values, list, text);
  findings.insert(findings.end(), list.list().begin(), list.list().end());
  return mission;
}

MissionProfile read_mission_profile(const std::filesystem::path& file,
                                    const VariableValues& values) {
  FindingList findings;
  auto mission = read_mission(file, values, findings);
  findings.throw_if_errors();
  return mission;
}

}  // namespace skein::profile
