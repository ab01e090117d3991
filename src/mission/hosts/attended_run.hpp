#pragma once

#include <chrono>
#include <string>

#include "mission/supervise/launch_plan.hpp"
#include "mission/supervise/supervisor.hpp"

namespace skein::launch {

/// An attended launcher that has heard nothing for so long ends its mission in order,
inline constexpr std::chrono::milliseconds kAttendancePatience{2500};
/// and kills what is left after so long, so that nothing runs on when the other one is gone.
inline constexpr std::chrono::milliseconds kLonelyGrace{1500};

/// Runs the processes of a plan for another launcher, which attends: it listens on `output` and
/// speaks on `input` (see attended_report.hpp). Starts nothing before the other side has accepted
/// `hello`. Ends everything where the other side says so, its words stop, `input` ends, or `output`
/// takes no more. Of `options`, the callbacks are replaced.
///
/// Returns the exit code. Call it before other threads exist: it blocks SIGINT, SIGTERM and SIGHUP,
/// and ignores SIGPIPE. It makes a thread, which it ends.
int run_attended(LaunchPlan plan, SupervisorOptions options, const std::string& hello,
                 int input = 0, int output = 1);

}  // namespace skein::launch
