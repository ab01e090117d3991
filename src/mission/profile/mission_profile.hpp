#pragma once

#include <filesystem>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "mission/component/component_description.hpp"
#include "mission/component/dictionary.hpp"
#include "mission/profile/process_start.hpp"
#include "mission/profile/restart_rules.hpp"
#include "mission/profile/thread_rules.hpp"
#include "mission/profile/topic_rules.hpp"
#include "skein/entity.hpp"

namespace skein::profile {

/// A value that the profile gives to a parameter of a component.
struct Setting {
  std::string name;
  std::string value;
  SourcePosition where;
  /// Of the value: the variable that gives it, the file from which it is read, or `where`.
  SourcePosition value_where;
  std::string file;  ///< From which the value is read; empty for a value that stands here.
};

enum class CspProcess {
  InOwner,  ///< `in`: in the process of its autonomous entity.
  Own,      ///< `own`: in a process of its own, which may crash alone.
};

/// One CSP of a peer.
struct CspProfile {
  std::string name;            ///< Unique in its peer; by default the component's name.
  std::string component_file;  ///< As it is named, relative to the file that names it.
  /// Null only where a profile with findings was read to collect them.
  std::shared_ptr<const ComponentDescription> component;
  CspProcess process = CspProcess::InOwner;
  std::string vendor;  ///< The peer's, unless the profile says otherwise.
  bool shared_memory =
      false;  ///< The peer's where both have one vendor, unless the profile says otherwise.
  std::optional<bool> shared_memory_calls;  ///< The peer's, unless the profile says otherwise.
  std::string plugin;                       ///< The peer's, unless the profile says otherwise.
  ProcessRules rules;                       ///< Of a process of its own.
  ProcessStart start;                       ///< Of a process of its own.
  ThreadRules threads;                      ///< Of the thread that runs it.
  std::vector<Setting> parameters;
  SourcePosition where;

  /// The value that the profile gives to that parameter, or null.
  const Setting* find_parameter(std::string_view parameter_name) const;
};

/// One peer of the mission: an autonomous entity with its CSPs.
struct PeerProfile {
  std::string name;            ///< Unique in the mission.
  std::string group;           ///< Where it stands in one.
  std::string component_file;  ///< As it is named, relative to the file that names it.
  /// Null where a program of its own has none. Otherwise null only where a profile with findings
  /// was read to collect them.
  std::shared_ptr<const ComponentDescription> component;
  std::string vendor;              ///< As dds::load_vendor() knows it.
  std::string system;              ///< The vehicle or station it belongs to.
  std::string host;                ///< Empty for the host of the launcher.
  std::string interface;           ///< Network interface; empty for this host alone (127.0.0.1).
  std::vector<std::string> peers;  ///< Hosts that it asks for others; see launch::network_of().
  bool multicast = false;          ///< Whether it finds others by multicast.
  bool shared_memory = false;      ///< The vendor's, between the processes of one host.
  std::optional<bool> shared_memory_calls;  ///< See EntityOptions.
  /// From which addresses it takes packets: of dds::Network.
  std::vector<std::string> allowed_sources;
  std::string plugin;         ///< Library with its providers; empty where main() registers them.
  bool runs_mission = false;  ///< Its end is the mission's, its exit code too.
  ProcessRules rules;
  ProcessStart start;
  ThreadRules threads;  ///< Of its public service.
  HeadOptions head;     ///< How it chooses among its CSPs.
  /// Of the topics that it and its CSPs publish and read.
  std::vector<TopicRules> topics;
  std::vector<CspProfile> csps;
  std::vector<Setting> parameters;
  SourcePosition where;

  const CspProfile* find_csp(std::string_view csp_name) const;           ///< Or null.
  const Setting* find_parameter(std::string_view parameter_name) const;  ///< Or null.
};

/// Which peers fly, from which components, with which CSPs. mission_profiles/README.md describes
/// the XML. A plain value.
struct MissionProfile {
  std::string name;
  int domain = 0;    ///< The DDS domain of the mission, 0 to 232.
  std::string logs;  ///< The folder of the launcher's logs; empty: see launch::log_folder().
  std::filesystem::path file;
  /// All that were read: this one, its parts, its dictionary, and the components.
  std::set<std::filesystem::path> files;
  Dictionary dictionary;
  std::vector<PeerProfile> peers;
  SourcePosition where;

  const PeerProfile* find_peer(std::string_view peer_name) const;  ///< Or null.
};

/// Values for a profile's variables, in place of their defaults.
using VariableValues = std::map<std::string, std::string>;

/// `NAME=VALUE` for each. Throws InvalidArgument for what is none.
VariableValues parse_variables(const std::vector<std::string>& assignments);

/// Reads a profile with its parts, its dictionary and all of its components. Says nothing of the
/// composition: see check.hpp. Throws DescriptionError with every finding of every file.
MissionProfile read_mission_profile(const std::filesystem::path& file,
                                    const VariableValues& values = {});

/// As above, but adds the findings to `findings` and gives what could be read: for tools that show
/// everything that is wrong in one go. `text`, unless null: what the file will hold.
MissionProfile read_mission_profile(const std::filesystem::path& file,
                                    std::vector<Finding>& findings,
                                    const VariableValues& values = {},
                                    const std::string* text = nullptr);

/// Gives a parameter a value from the command line, `PEER.PARAMETER=VALUE` or
/// `PEER/CSP.PARAMETER=VALUE`, in place of the profile's. Throws InvalidArgument for an unknown
/// peer, CSP or parameter, with a suggestion, and for a value that the dictionary refuses.
void apply_setting(MissionProfile& profile, std::string_view assignment);

/// Throws InvalidArgument for what has not the form of such an assignment, whatever it names.
void demand_setting(std::string_view assignment);

}  // namespace skein::profile
