#pragma once

#include <string>
#include <vector>

#include "mission/profile/mission_profile.hpp"

namespace skein::launch {

/// What a run depends on beside its programs, one fact a line, for its log: versions, the machine,
/// the command line, the profile with every parameter that it or the command line sets (seeds among
/// them), and the variables of the environment that Skein and the vendors read: without their
/// values where their names end with TOKEN, SECRET, PASSWORD or KEY.
std::vector<std::string> environment_record(const profile::MissionProfile& mission,
                                            const std::string& version);

}  // namespace skein::launch
