#pragma once

#include <string>

#include "mission/supervise/launch_plan.hpp"

namespace skein::launch {

/// The word as a POSIX shell reads it: as it is where that is the same, else in single quotes.
std::string shell_word(const std::string& word);

/// The command line of a process, after `NAME=value` for each variable of its environment.
std::string shell_command(const ChildPlan& child);

}  // namespace skein::launch
