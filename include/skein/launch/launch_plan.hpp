#pragma once

#include <functional>
#include <string>
#include <utility>
#include <vector>

#include "skein/profile/mission_profile.hpp"

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
};

/// Makes the command line of one process. `csp` is null for the peer's own process.
using MakeArgv = std::function<std::vector<std::string>(const profile::PeerProfile& peer,
                                                        const profile::CspProfile* csp)>;

/// The processes of a mission that belong to `host`: those whose profile names it, and those whose
/// profile names no host. One for each peer, one for each CSP with process="own".
LaunchPlan make_launch_plan(const profile::MissionProfile& mission, const MakeArgv& make_argv,
                            const std::string& host = {});

/// What would be started, for people: each process with its command line as a shell would read it,
/// its readiness, restart and stop rules, and what its end means for the mission.
std::string to_text(const LaunchPlan& plan);

}  // namespace skein::launch
