#include "mission/check/machine_check.hpp"

#include <unistd.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <map>
#include <set>
#include <sstream>

#include "core/suggestion.hpp"
#include "core/system/host.hpp"
#include "core/system/network_interface.hpp"
#include "core/threads/thread_settings.hpp"
#include "dds/port/vendor_names.hpp"
#include "findings_apart.hpp"
#include "mission/peer/component_code.hpp"
#include "mission/peer/peer.hpp"
#include "mission/supervise/launch_plan.hpp"
#include "skein/component_registry.hpp"
#include "skein/error.hpp"
#include "skein/selection.hpp"
#include "skein/vendor.hpp"

namespace skein::launch {
namespace {

using profile::CspProcess;
using profile::CspProfile;
using profile::Finding;
using profile::MissionProfile;
using profile::PeerProfile;
using profile::Severity;

/// What stands against a host's name; nothing where it has an address.
struct HostObstacle {
  std::string problem;
  bool passing = false;
};

HostObstacle obstacle(const std::string& host) {
  try {
    host_addresses(host);
    return {};
  } catch (const Error& error) {
    return {error.what(), error.code() == ErrorCode::Unavailable};
  }
}

/// As execvp(3) would find it.
bool is_executable(const std::string& program) {
  const auto fits = [](const std::string& file) {
    std::error_code ignored;
    return std::filesystem::is_regular_file(file, ignored) && ::access(file.c_str(), X_OK) == 0;
  };
  if (program.find('/') != std::string::npos) return fits(program);
  const char* path = std::getenv("PATH");
  std::istringstream folders(path != nullptr ? path : "/bin:/usr/bin");
  for (std::string folder; std::getline(folders, folder, ':');) {
    if (fits((folder.empty() ? "." : folder) + "/" + program)) return true;
  }
  return false;
}

class MachineCheck {
 public:
  MachineCheck(const MissionProfile& mission, const std::string& host)
      : mission_(mission), interfaces_(interfaces_of_this_host()) {
    for (const std::string& name : hosts_of(mission)) here_[name] = launch::is_here(name, host);
  }

  std::vector<Finding> run() {
    for (const PeerProfile& peer : mission_.peers) {
      if (!is_here(peer)) continue;
      if (peer.start.program.empty()) {
        check_interface(peer);
        check_meeting(peer);
      } else {
        check_program(peer.start.program, peer.name, peer.where);
      }
      check_cpus(peer, peer.name);
      for (const CspProfile& csp : peer.csps) {
        const std::string name = peer.name + "/" + csp.name;
        check_cpus(csp, name);
        if (!csp.start.program.empty()) check_program(csp.start.program, name, csp.where);
      }
    }
    return std::move(findings_);
  }

 private:
  using SourcePosition = profile::SourcePosition;

  void add(Severity severity, const SourcePosition& where, std::string problem, std::string remedy,
           bool passing = false) {
    findings_.push_back({severity, where, std::move(problem), std::move(remedy), passing});
  }

  bool is_here(const PeerProfile& peer) const {
    const auto found = here_.find(peer.host);
    return found == here_.end() || found->second;
  }

  void check_interface(const PeerProfile& peer) {
    const std::string& wanted = peer.interface;
    const auto down = find_obstacle(network_interfaces_, wanted);
    if (down && peer.vendor != dds::kLoopback) {
      if (!told_down_.insert(down->problem).second) return;
      return add(Severity::Error, peer.where, "'" + peer.name + "' cannot speak: " + down->problem,
                 down->remedy, true);
    }
    const bool known = wanted.empty() || wanted.starts_with("127.") ||
                       std::ranges::any_of(interfaces_, [&](const HostInterface& interface) {
                         return wanted == interface.name || wanted == interface.address;
                       });
    if (known) return;
    std::vector<std::string> names;
    for (const HostInterface& interface : interfaces_) names.push_back(interface.name);
    add(Severity::Error, peer.where,
        "'" + peer.name + "' speaks on '" + wanted +
            "', but this host has no such interface with an IPv4 address" +
            suggestion(wanted, names),
        "it has " + to_text(interfaces_), !is_misspelled_interface(wanted, names));
  }

  /// Whether the peer can meet those of other hosts.
  void check_meeting(const PeerProfile& peer) {
    const auto elsewhere =
        std::ranges::find(here_, false, &std::pair<const std::string, bool>::second);
    if (elsewhere != here_.end()) {
      if (peer.interface.empty() && peer.vendor != dds::kLoopback) {
        add(Severity::Error, peer.where,
            "'" + peer.name + "' speaks on 127.0.0.1 alone, and the mission has peers on '" +
                elsewhere->first + "'",
            "name the network interface on which it meets them: interface=\"...\" (this host has " +
                to_text(interfaces_) + "), or interface=\"lo\" where it need not");
      }
      if (peer.host.empty()) {
        add(Severity::Warning, peer.where,
            "'" + peer.name + "' names no host, though others do: each launcher would start it",
            "write host=\"...\"");
      }
    }
    for (const std::string& host : network_of(mission_, peer).peers) {
      const auto [problem, passing] = obstacle(host);
      if (problem.empty() || !asked_.insert(host).second) continue;
      add(Severity::Error, peer.where,
          "'" + peer.name + "' is to look for peers there, but " + problem,
          peer.peers.empty() ? "write host=\"...\" as an address, add the name to /etc/hosts, or "
                               "say where to look: "
                               "peers=\"...\" or multicast=\"true\""
                             : "write an address in peers=\"...\", or add the name to /etc/hosts",
          passing);
    }
  }

  void check_program(const std::string& program, const std::string& of,
                     const SourcePosition& where) {
    if (is_executable(program)) return;
    const bool path = program.find('/') != std::string::npos;
    const bool line = program.find(' ') != std::string::npos;
    add(Severity::Error, where,
        "the program '" + program + "' of '" + of + "' " +
            (path ? "cannot be executed" : "is not in PATH"),
        line   ? "write its arguments as <argument value=\"...\"/>"
        : path ? "check the path, and that its file is executable"
               : "install it, or write a path with a slash");
  }

  /// `owner` is a peer or a CSP.
  template <class Owner>
  void check_cpus(const Owner& owner, const std::string& name) {
    ThreadSettings of_process;
    of_process.cpus = owner.start.cpus;
    try {
      check(owner.threads.settings, "'" + name + "'");
      check(of_process, "'" + name + "'");
    } catch (const InvalidArgument& error) {
      add(Severity::Error, owner.where, error.what(), "");
    }
  }

  const MissionProfile& mission_;
  const std::vector<HostInterface> interfaces_;
  const std::vector<NetworkInterface> network_interfaces_ = network_interfaces();
  std::set<std::string> told_down_;
  std::map<std::string, bool> here_;  // each host that the profile names
  std::set<std::string> asked_;       // those of them that have no address, and are an error
  std::vector<Finding> findings_;
};

/// Whether a process finds other libraries than this one would.
bool looks_elsewhere(const profile::ProcessStart& start) {
  return std::ranges::any_of(start.environment, [](const auto& variable) {
    return variable.first == "SKEIN_MODULE_PATH" || variable.first.starts_with("LD_");
  });
}

class PluginCheck {
 public:
  PluginCheck(const MissionProfile& mission, const TellStep& tell_step)
      : mission_(mission), tell_step_(tell_step) {}

  std::vector<Finding> run(const std::string& host) {
    for (const PeerProfile& peer : mission_.peers) {
      if (!is_here(peer.host, host) || !peer.start.program.empty()) continue;
      if (can_check(peer, peer.name)) check_process(peer);
      for (const CspProfile& csp : peer.csps) {
        if (csp.process != CspProcess::Own || !csp.component || !csp.start.program.empty())
          continue;
        if (can_check(csp, peer.name + "/" + csp.name)) check_own(csp);
      }
    }
    return std::move(findings_);
  }

 private:
  void add(const profile::SourcePosition& where, std::string problem, std::string remedy,
           Severity severity = Severity::Error) {
    const bool known = std::ranges::any_of(
        findings_, [&](const Finding& finding) { return finding.problem == problem; });
    if (known) return;  // many peers may name one plugin
    findings_.push_back({severity, where, std::move(problem), std::move(remedy)});
  }

  /// Of a peer, or a CSP with a process of its own: false, with a note, where the process loads
  /// what this one does not find. Otherwise its vendor's module is checked.
  template <class Profile>
  bool can_check(const Profile& profile, const std::string& name) {
    if (looks_elsewhere(profile.start)) {
      add(profile.where,
          "the vendor and the plugins of '" + name +
              "' were not checked, since its <environment> says where libraries are",
          "its process says at its start what is missing", Severity::Note);
      return false;
    }
    const auto& vendors = dds::vendor_names();
    if (std::ranges::count(vendors, profile.vendor) == 0) return true;  // an error of the reader
    tell_step_({Severity::Error, profile.where, "loading the vendor '" + profile.vendor + "'",
                "install its module anew, from the same build as this skein"});
    try {
      dds::load_vendor(profile.vendor);
    } catch (const Error& error) {
      add(profile.where, "the vendor '" + profile.vendor + "': " + error.what(), "");
    }
    return true;
  }

  /// False, with a finding, where it cannot be loaded.
  bool load(LoadedPlugins& plugins, const std::string& plugin,
            const profile::SourcePosition& where) {
    if (plugin.empty()) return true;
    tell_step_({Severity::Error, where, "loading the plugin '" + plugin + "'",
                "look at what runs then: its skein_register_components, and the constructors of "
                "its global objects"});
    try {
      plugins.load(plugin);
      check_versions(plugins, where);
      return true;
    } catch (const std::exception& error) {
      add(where, "the plugin '" + plugin + "': " + error.what(), "");
    }
    return false;
  }

  /// Also of plugins in different processes: whoever calls across them finds no provider.
  void check_versions(const LoadedPlugins& plugins, const profile::SourcePosition& where) {
    for (std::string& text : add_versions(held_, plugins.interfaces()))
      add(where, std::move(text), "build both from the same IDL", Severity::Warning);
  }

  /// A peer with the CSPs in its process, as it would be started.
  void check_process(const PeerProfile& peer) {
    ComponentRegistry registry;
    LoadedPlugins plugins(registry);
    if (!load(plugins, peer.plugin, peer.where)) return;
    for (const CspProfile& csp : peer.csps) {
      if (csp.process == CspProcess::InOwner && !load(plugins, csp.plugin, csp.where)) return;
    }
    check_strategy(peer, registry);
    for (const CspProfile& csp : peer.csps) {
      if (csp.process == CspProcess::InOwner && csp.component) check_owner(csp, plugins);
    }
    if (peer.component) check_owner(peer, plugins);
  }

  void check_strategy(const PeerProfile& peer, const ComponentRegistry& registry) {
    StrategyFactory strategies;
    for (const auto& strategy : registry.strategies()) strategies.add(strategy);
    try {
      strategies.make(peer.head.strategy);
    } catch (const InvalidArgument& error) {
      add(peer.where, "'" + peer.name + "': " + error.what(), "");
    }
  }

  void check_own(const CspProfile& csp) {
    ComponentRegistry registry;
    LoadedPlugins plugins(registry);
    if (load(plugins, csp.plugin, csp.where)) check_owner(csp, plugins);
  }

  /// What is wrong with a description is a finding of its reader, and no other one follows from it.
  static bool is_told_already(const PeerProfile& peer) { return !peer.component->complete; }
  static bool is_told_already(const CspProfile& csp) {
    return !csp.component->complete || csp.component->interfaces.empty();
  }

  /// Of a peer or a CSP, whose component has been read.
  template <class Profile>
  void check_owner(const Profile& profile, const LoadedPlugins& plugins) {
    demand_code(profile, plugins);
    tell_step_({Severity::Error, profile.where, "checking the values of '" + profile.name + "'",
                "look at the checks that its plugin adds by add_check"});
    for (Finding& finding :
         find_wrong_values(profile.parameters, mission_.dictionary, plugins.registry()))
      add(finding.where, std::move(finding.problem), std::move(finding.remedy));
  }

  template <class Profile>
  void demand_code(const Profile& profile, const LoadedPlugins& plugins) {
    if (is_told_already(profile)) return;
    if (const auto lack = find_lack(profile, plugins)) {
      add(profile.where, lack->problem, lack->remedy);
    } else if (!profile.component->interfaces.empty()) {
      check_interfaces(*profile.component, plugins.registry());
    }
  }

  /// What the description declares against what the code implements.
  void check_interfaces(const profile::ComponentDescription& component,
                        const ComponentRegistry& registry) {
    const InterfaceInfo* code = registry.find_interface(component.name);
    if (!code) {
      add(component.where,
          "whether the code of '" + component.name +
              "' implements what its description says was not checked, since its plugin does not "
              "name the interface",
          "register it by add_body<INTERFACE> or add_csp<INTERFACE>", Severity::Note);
      return;
    }
    for (Finding& finding : compare(component, *code))
      add(finding.where, std::move(finding.problem), std::move(finding.remedy));
  }

  const MissionProfile& mission_;
  const TellStep& tell_step_;
  std::vector<LoadedPlugins::Held> held_;  // by the plugins of the whole mission
  std::vector<Finding> findings_;
};

}  // namespace

std::vector<Finding> check_machine(const MissionProfile& mission, const std::string& host) {
  return MachineCheck(mission, host).run();
}

std::vector<Finding> check_hosts(const MissionProfile& mission, const std::string& host) {
  std::vector<Finding> findings;
  for (const std::string& name : hosts_of(mission)) {
    if (is_here(name, host)) continue;
    const auto first = std::ranges::find(mission.peers, name, &PeerProfile::host);
    findings.push_back({Severity::Note, first->where,
                        "of the host '" + name + "' only the profile was checked",
                        "'skein check' there checks its plugins, vendors, CPUs and interfaces"});
    if (obstacle(name).problem.empty()) continue;
    const bool asked = std::ranges::any_of(mission.peers, [&](const PeerProfile& peer) {
      return is_here(peer.host, host) &&
             std::ranges::count(network_of(mission, peer).peers, name) > 0;
    });
    if (asked) continue;  // which is an error of check_machine()
    findings.push_back(
        {Severity::Warning, first->where,
         "the host '" + name + "' of '" + first->name + "' has no address that is known here",
         "there, 'skein launch --host " + name + "' starts its peers"});
  }
  return findings;
}

std::vector<Finding> check_plugins(const MissionProfile& mission, const std::string& host) {
  return findings_apart(
      [&](const TellStep& tell_step) { return PluginCheck(mission, tell_step).run(host); },
      mission.file);
}

}  // namespace skein::launch
