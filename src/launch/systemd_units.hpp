#pragma once

#include <map>
#include <string>

#include "launch/launch_plan.hpp"

namespace skein::launch {

/// The plan as units of systemd (252 or later), by file name: a service for each process, which
/// tells systemd by itself when it is ready (see ready.hpp); a target for the mission; and one that
/// is reached when the mission is over, and ends the rest of it.
///
/// Where systemd has no equal, the nearest: the wait before a restart does not grow, and the first
/// start counts as one within the restart window. Throws InvalidArgument for what a unit cannot
/// hold, and says what: a name that is too long, control characters in a value of the environment.
std::map<std::string, std::string> systemd_units(const LaunchPlan& plan);

/// A word of a unit's setting, of any bytes but zero: in quotes, with escapes and specifiers
/// (`%`) disarmed. Dollars mean something in a command alone, unless that begins with a colon.
std::string unit_word(const std::string& word);

/// A text as a part of a unit's name: letters, digits and `_` as they are, a slash as `-`, all else
/// as `\xNN`, as systemd-escape does it.
std::string unit_name_part(const std::string& text);

}  // namespace skein::launch
