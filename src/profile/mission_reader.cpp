#include <algorithm>
#include <array>
#include <charconv>
#include <sstream>

#include "component_cache.hpp"
#include "dds/allowed_sources.hpp"
#include "dds/vendor_names.hpp"
#include "dictionary_reader.hpp"
#include "head_reader.hpp"
#include "profile/mission_profile.hpp"
#include "rules_reader.hpp"
#include "skein/error.hpp"
#include "text_file.hpp"
#include "thread_rules_reader.hpp"
#include "value_readers.hpp"
#include "words.hpp"

namespace skein::profile {
namespace {

constexpr int kLargestDomain = 232;
constexpr std::size_t kLongestName = 64;
constexpr std::size_t kMaxHosts = 64;

/// The attributes of the mission that each peer has unless it says otherwise.
constexpr std::array kInheritedAttributes{"vendor", "system",    "host",   "interface",
                                          "peers",  "multicast", "plugin", "allowed_sources"};

/// The attributes of an element: its own, and those of the readers that it is handed to.
template <class... Lists>
std::vector<std::string_view> joined(const Lists&... lists) {
  std::vector<std::string_view> names;
  (names.insert(names.end(), lists.begin(), lists.end()), ...);
  return names;
}

/// What a peer has unless it says otherwise.
struct Defaults {
  std::string vendor = dds::vendor_names().front();
  std::string system = "default";
  std::string host;
  std::string interface;
  std::vector<std::string> peers;
  bool multicast = false;
  std::string plugin;
  std::vector<std::string> allowed_sources;
};

class MissionReader {
 public:
  MissionReader(const std::filesystem::path& file, FindingList& findings)
      : file_(file), findings_(findings), components_(file.parent_path(), findings) {}

  MissionProfile read(const XmlElement& root) {
    MissionProfile mission;
    mission.file = file_;
    mission.where = root.where();
    if (root.name() != "mission") {
      findings_.error(root.where(), "<" + shortened(root.name()) + "> is no mission profile",
                      "its outermost element is <mission name=\"...\">");
      return mission;
    }
    root.allow(joined(std::array{"name", "domain", "dictionary"}, kInheritedAttributes), {"peer"});
    mission.name = root.attribute("name").value;
    mission.domain = domain_of(root);
    mission.dictionary = dictionary_of(root);
    const Defaults defaults = defaults_of(root, Defaults{});
    for (const auto& child : root.children("peer")) {
      mission.peers.push_back(peer_of(child, defaults));
    }
    if (mission.peers.empty()) findings_.error(root.where(), "the mission has no <peer>");
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

  Dictionary dictionary_of(const XmlElement& root) {
    const auto named = root.maybe_attribute("dictionary");
    const auto path = file_.parent_path() / (named ? named->value : "dictionary.xml");
    try {
      const XmlDocument document(read_text_file(path), path.string());
      return read_dictionary(document, findings_);
    } catch (const DescriptionError& error) {
      findings_.error(named ? named->where : root.where(), "the dictionary cannot be read",
                      "name its file, relative to the profile: dictionary=\"...\"");
      findings_.add_all(error.findings());
      return {};
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

  std::vector<std::string> allowed_sources_of(const XmlElement& element,
                                              const std::vector<std::string>& fallback) {
    const auto attribute = element.maybe_attribute("allowed_sources");
    if (!attribute) return fallback;
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

  Defaults defaults_of(const XmlElement& element, const Defaults& outer) {
    return {vendor_of(element, outer.vendor),
            value_or(element, "system", outer.system),
            value_or(element, "host", outer.host),
            value_or(element, "interface", outer.interface),
            hosts_of(element, outer.peers),
            read_boolean(element, "multicast", outer.multicast),
            value_or(element, "plugin", outer.plugin),
            allowed_sources_of(element, outer.allowed_sources)};
  }

  /// Names or addresses, separated by blanks or commas.
  std::vector<std::string> hosts_of(const XmlElement& element, std::vector<std::string> fallback) {
    const auto list = element.maybe_attribute("peers");
    if (!list) return fallback;
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

  /// Names become parts of topics, partitions, log lines and command lines.
  void demand_plain_name(const std::string& name, const SourcePosition& where) {
    const bool plain = std::all_of(name.begin(), name.end(), [](char c) {
      return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') ||
             c == '_' || c == '-';
    });
    if (plain && name.size() <= kLongestName) return;
    findings_.error(where, in_quotes(name) + " is no name",
                    "use letters, digits, _ and -, at most " + std::to_string(kLongestName));
  }

  std::vector<Setting> parameters_of(const XmlElement& element) {
    std::vector<Setting> settings;
    for (const auto& child : element.children("parameter")) {
      child.allow({"name", "value"}, {});
      settings.push_back(
          {child.attribute("name").value, child.attribute("value").value, child.where()});
    }
    return settings;
  }

  PeerProfile peer_of(const XmlElement& element, const Defaults& mission) {
    element.allow(joined(std::array{"name", "component"}, kInheritedAttributes,
                         std::array{"shared_memory", "role", "required"}, kProcessAttributes,
                         kThreadCountAttributes, kThreadAttributes, kHeadAttributes),
                  {"csp", "parameter"});
    PeerProfile peer;
    peer.where = element.where();
    const auto name = element.attribute("name");
    peer.name = name.value;
    demand_plain_name(name.value, name.where);
    const auto component = element.attribute("component");
    peer.component_file = component.value;
    peer.component = components_.read(component.value, component.where);
    auto values = defaults_of(element, mission);
    peer.vendor = std::move(values.vendor);
    peer.system = std::move(values.system);
    peer.host = std::move(values.host);
    peer.interface = std::move(values.interface);
    peer.peers = std::move(values.peers);
    peer.multicast = values.multicast;
    peer.allowed_sources = std::move(values.allowed_sources);
    peer.shared_memory = shared_memory_of(element, peer.vendor, false);
    peer.plugin = std::move(values.plugin);
    peer.runs_mission = runs_mission(element);
    peer.required = read_boolean(element, "required", true);
    peer.rules = read_process_rules(element);
    peer.threads = read_thread_rules(element);
    peer.head = read_head_options(element);
    peer.parameters = parameters_of(element);
    for (const auto& child : element.children("csp")) peer.csps.push_back(csp_of(child, peer));
    return peer;
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

  CspProfile csp_of(const XmlElement& element, const PeerProfile& peer) {
    element.allow(joined(std::array{"name", "component", "process", "vendor", "shared_memory",
                                    "plugin", "required"},
                         kProcessAttributes, kThreadAttributes),
                  {"parameter"});
    CspProfile csp;
    csp.where = element.where();
    const auto component = element.attribute("component");
    csp.component_file = component.value;
    csp.component = components_.read(component.value, component.where);
    const auto name = element.maybe_attribute("name");
    csp.name = name ? name->value : csp.component ? csp.component->name : "";
    demand_plain_name(csp.name, name ? name->where : element.where());
    csp.process = process_of(element);
    csp.vendor = vendor_of(element, peer.vendor);
    csp.shared_memory = shared_memory_of(element, csp.vendor, peer.shared_memory);
    csp.plugin = value_or(element, "plugin", peer.plugin);
    csp.required = read_boolean(element, "required", false);
    csp.rules = read_process_rules(element);
    csp.threads = read_thread_rules(element);
    csp.parameters = parameters_of(element);
    if (csp.process == CspProcess::InOwner) refuse_process_rules(element);
    if (csp.process == CspProcess::Own && csp.threads.thread == CallThread::Caller) {
      findings_.error(element.maybe_attribute("thread")->where,
                      "a CSP in a process of its own cannot run on its caller's thread",
                      "leave thread out, or write process=\"in\"");
    }
    return csp;
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
};

MissionProfile read_mission(const std::filesystem::path& file, FindingList& findings) {
  try {
    const XmlDocument document(read_text_file(file), file.string());
    return MissionReader(file, findings).read(XmlElement(document.root(), document, findings));
  } catch (const DescriptionError& error) {
    findings.add_all(error.findings());
    return {};
  }
}

}  // namespace

MissionProfile read_mission_profile(const std::filesystem::path& file,
                                    std::vector<Finding>& findings) {
  FindingList list;
  auto mission = read_mission(file, list);
  findings.insert(findings.end(), list.list().begin(), list.list().end());
  return mission;
}

MissionProfile read_mission_profile(const std::filesystem::path& file) {
  FindingList findings;
  auto mission = read_mission(file, findings);
  findings.throw_if_errors();
  return mission;
}

}  // namespace skein::profile
