#pragma once

#include <array>
#include <string_view>

namespace skein::launch {

// Exit codes of a launcher. They are those of sysexits.h and of the shell, so that they do not meet
// the small numbers that missions end with.
inline constexpr int kUsageError = 64;
inline constexpr int kPeerLost = 70;
inline constexpr int kStartFailed = 71;
inline constexpr int kOutputLost = 74;
inline constexpr int kDegraded = 75;
inline constexpr int kMissionFailed = 76;
inline constexpr int kConfigurationError = 78;
inline constexpr int kInterrupted = 128;  ///< Plus the signal's number.

struct ExitCode {
  std::string_view code;  ///< A number, or `128 + N`.
  std::string_view meaning;
};

/// All that `skein launch` ends with, one for each cause: the only place that says so. Other
/// commands end with the same, as far as it concerns them. A test compares
/// mission_profiles/README.md with it.
inline constexpr std::array kExitCodes{
    ExitCode{"0",
             "the mission's peer ended with 0, and nothing was lost that degrades the mission"},
    ExitCode{"1 to 255", "the code of the mission's peer; 128 + N if it ended by signal N"},
    ExitCode{"64", "the command line is wrong; nothing was done"},
    ExitCode{
        "70",
        "a process with on_loss=abort was lost: it ended, or was killed as hung, and was given "
        "up"},
    ExitCode{"71",
             "something could not be started, or a process with on_loss=abort never became ready"},
    ExitCode{"74", "all went well, but the output could not be written"},
    ExitCode{"75", "all went well, but a process with on_loss=degrade was lost on the way"},
    ExitCode{"76", "the mission ended by an exception, which is on stderr"},
    ExitCode{"78",
             "the profile, a file or a name is wrong, there was nothing to start here, or the "
             "mission is running here already; nothing was started. Or a process with "
             "on_loss=abort, or on_loss=degrade before it was ready, ended with this code"},
    ExitCode{"128 + N", "the launcher was interrupted by signal N"},
};

}  // namespace skein::launch
