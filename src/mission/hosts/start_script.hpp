#pragma once

#include <string>

#include "mission/supervise/launch_plan.hpp"

namespace skein::launch {

/// The plan as a script for any POSIX shell, which needs nothing of Skein but the programs that the
/// plan names: it starts the processes in the plan's order, waits until they say that they are
/// ready (see ready.hpp), ends them in reverse when the mission ends or on SIGINT, SIGTERM or
/// SIGHUP, and exits with the code that `skein launch` would have. It leaves no process behind,
/// even where it is killed. It starts no process a second time, and limits are whole seconds.
std::string start_script(const LaunchPlan& plan);

}  // namespace skein::launch
