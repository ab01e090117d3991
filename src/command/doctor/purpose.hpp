#pragma once

#include <string>

#include "facts.hpp"
#include "mission/profile/mission_profile.hpp"

namespace skein::command::doctor {

/// What the peers of `host` (see launch::is_here()) need of their machine.
Purpose purpose_of(const profile::MissionProfile& mission, const std::string& host);

}  // namespace skein::command::doctor
