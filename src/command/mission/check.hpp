#pragma once

#include <vector>

#include "command/commands.hpp"
#include "mission/profile/mission_profile.hpp"
#include "mission/xml/finding.hpp"

namespace skein::command {

struct CheckedMission {
  profile::MissionProfile mission;  ///< What could be read.
  std::vector<profile::Finding> findings;
};

/// Reads a mission and finds what is wrong with it, in the profile and on this machine: what
/// keeps `launch` from starting anything. Plugins and vendors' modules are
/// those of the peers that the arguments choose. Throws InvalidArgument for a setting that the
/// profile does not take. `text_file`, unless empty: has what the profile will hold.
CheckedMission check_mission(const PlanArguments& arguments, const std::string& text_file = {});

/// The same, with what concerns other hosts: all that `check` tells.
std::vector<profile::Finding> findings_of(const CheckArguments& arguments);

}  // namespace skein::command
