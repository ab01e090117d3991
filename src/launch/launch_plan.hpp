#pragma once

#include <functional>
#include <string>
#include <utility>
#include <vector>

#include "profile/mission_profile.hpp"

namespace skein::launch {

/// One process of a mission.
struct ChildPlan {
  std::string name;  ///< `peer`, or `peer/csp` for a CSP with a process of its own.
  std::vector<std::string>
      argv;  ///< Program (looked for in PATH if without a slash) and arguments.
  std::vector<std::pair<std::string, std::string>> environment;  ///< Added to the launcher's own.
  profile::ProcessRules rules;
  bool runs_mission = false;  ///< Its end ends the mission; its exit code is the mission's.
  bool required = true;       ///< Its loss ends the mission.
};

struct LaunchPlan {
  std::string mission;
  std::vector<ChildPlan> children;
  std::vector<std::string> elsewhere;  ///< Processes of other hosts, which are not started here.
  /// The peer that runs the mission, where it is one of those: this launcher does not see its end,
  /// and runs until it is interrupted or its own processes have ended.
  std::string mission_elsewhere{};
};

/// Why a launcher of `host` has nothing to start: who it is, and which hosts the peers name.
std::string nobody_here(const profile::MissionProfile& mission, const std::string& host);

/// Makes the command line of one process. `csp` is null for the peer's own process.
using MakeArgv = std::function<std::vector<std::string>(const profile::PeerProfile& peer,
                                                        const profile::CspProfile* csp)>;

/// Whether a peer with host=`wanted` belongs to a launcher that was told to be on the host `self`.
/// Nothing and `localhost` do always. Where `self` is empty the machine tells: see is_this_host().
bool is_here(const std::string& wanted, const std::string& self);

/// The hosts that the mission's peers name, each once, without `localhost`.
std::vector<std::string> hosts_of(const profile::MissionProfile& mission);

/// The processes of a mission that belong to `host`, as is_here() says. One for each peer, one for
/// each CSP with process="own".
LaunchPlan make_launch_plan(const profile::MissionProfile& mission, const MakeArgv& make_argv,
                            const std::string& host = {});

/// What would be started, for people: each process with its command line as a shell would read it,
/// its readiness, restart and stop rules, and what its end means for the mission.
std::string to_text(const LaunchPlan& plan);

}  // namespace skein::launch
