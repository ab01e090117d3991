#pragma once

#include <functional>
#include <string>
#include <utility>
#include <vector>

#include "mission/profile/mission_profile.hpp"
#include "mission/supervise/start_order.hpp"

namespace skein::launch {

/// One process of a mission.
struct ChildPlan {
  std::string name;  ///< `peer`, or `peer/csp` for a CSP with a process of its own.
  std::vector<std::string>
      argv;  ///< Program (looked for in PATH if without a slash) and arguments.
  /// Added to the launcher's own, or in its place.
  std::vector<std::pair<std::string, std::string>> environment;
  profile::ProcessRules rules{};
  bool runs_mission = false;          ///< Its end ends the mission; its exit code is the mission's.
  bool tells_ready = true;            ///< False: it is ready as soon as it runs.
  std::size_t layer = 0;              ///< In the order of the start.
  std::vector<Prerequisite> after{};  ///< What must be ready before it is started.
  std::string system{};               ///< The peer's vehicle or station.
};

/// Behind the names of processes of this host that are not started.
inline constexpr const char* kLeftOut = ", which --only leaves out";

struct LaunchPlan {
  std::string mission;
  std::vector<ChildPlan> children;
  std::vector<std::string> elsewhere;  ///< Processes that are not started here, and why.
  /// The peer that runs the mission, where it is one of those: this launcher does not see its end,
  /// and runs until it is interrupted or its own processes have ended.
  std::string mission_elsewhere{};
  int domain = 0;
};

/// Why a launcher of `host` has nothing to start: who it is, and which hosts the peers name.
std::string nobody_here(const profile::MissionProfile& mission, const std::string& host);

/// Makes the command line of one process, as far as it is `skein peer` and without the arguments
/// that the profile gives it. `csp` is null for the peer's own process.
using MakeArgv = std::function<std::vector<std::string>(const profile::PeerProfile& peer,
                                                        const profile::CspProfile* csp)>;

/// Whether a peer with host=`wanted` belongs to a launcher that was told to be on the host `self`.
/// Nothing and `localhost` do always. Where `self` is empty the machine tells: see is_this_host().
bool is_here(const std::string& wanted, const std::string& self);

/// Whether `only` names the peer or its group, or nothing at all.
bool is_chosen(const profile::PeerProfile& peer, const std::vector<std::string>& only);

/// The hosts that the mission's peers name, each once, without `localhost`.
std::vector<std::string> hosts_of(const profile::MissionProfile& mission);

/// The processes of a mission that belong to `host`, as is_here() says. One for each peer, one for
/// each CSP with process="own". Where `only` names peers and groups, theirs alone; throws
/// InvalidArgument for a name that is neither, with a suggestion.
LaunchPlan make_launch_plan(const profile::MissionProfile& mission, const MakeArgv& make_argv,
                            const std::string& host = {},
                            const std::vector<std::string>& only = {});

/// What would be started, for people, layer by layer: each process with its command line as a shell
/// would read it, what it is started after, its rules of readiness, progress, restart and stop, and
/// what its end means for the mission.
std::string to_text(const LaunchPlan& plan);

}  // namespace skein::launch
