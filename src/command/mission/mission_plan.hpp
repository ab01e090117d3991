#pragma once

#include <string>
#include <vector>

#include "command/commands.hpp"
#include "mission/profile/mission_profile.hpp"
#include "mission/supervise/launch_plan.hpp"

namespace skein::command {

/// The checked profile, with the values that the command line sets. Throws DescriptionError with
/// every finding, InvalidArgument for a value that it does not take.
profile::MissionProfile read_mission(const MissionArguments& arguments);

/// The processes of the arguments' host, each as a run of this program's `peer`.
launch::LaunchPlan plan_of(const profile::MissionProfile& mission, const PlanArguments& arguments);

/// Adds to a command line the options that change what a profile says.
void pass_on(std::vector<std::string>& argv, const MissionArguments& arguments);
/// Those that choose peers, too, but for the host.
void pass_on_choice(std::vector<std::string>& argv, const PlanArguments& arguments);

/// Adds one process for each other host that the mission names: it starts that host's peers over
/// ssh, by `attend`, and its end means what theirs would mean together.
void add_other_hosts(launch::LaunchPlan& plan, const profile::MissionProfile& mission,
                     const LaunchArguments& arguments);

/// What two launchers of one mission must agree on: Skein's version, and a number for all that the
/// profile, its parts, its dictionary and its components say.
std::string hello_of(const profile::MissionProfile& mission);

}  // namespace skein::command
