#pragma once

#include <array>
#include <string_view>

namespace skein::launch {

// Exit codes of `skein`. They are those of sysexits.h and of the shell, so that they do not meet
// the small numbers that missions end with.
inline constexpr int kUsageError = 64;
inline constexpr int kNothingThere = 69;
inline constexpr int kPeerLost = 70;
inline constexpr int kStartFailed = 71;
inline constexpr int kOutputLost = 74;
inline constexpr int kDegraded = 75;
inline constexpr int kMissionFailed = 76;
inline constexpr int kConfigurationError = 78;
inline constexpr int kNoAnswer = 124;
inline constexpr int kInterrupted = 128;  ///< Plus the signal's number.

/// The kinds of commands that list exit codes in their help.
struct CommandKind {
  std::string_view name;
};
inline constexpr CommandKind kLaunch{"launch"};
inline constexpr CommandKind kLooking{"looking at a domain or a recording"};
inline constexpr CommandKind kAsking{"status and restart"};  ///< Which ask a launcher.
inline constexpr CommandKind kDoctor{"doctor"};
inline constexpr CommandKind kPlanning{"check, script and new"};

struct ExitCode {
  const CommandKind* of;  ///< Null: of all.
  std::string_view code;  ///< A number, or `128 + N`.
  std::string_view meaning;
};

/// All exit codes in ascending order, a row for each kind of command and cause. Help and manual
/// pages print this table; a test ends a command with each code.
inline constexpr std::array kExitCodes{
    ExitCode{&kLaunch, "0",
             "the mission's peer ended with 0, and nothing was lost that degrades the mission"},
    ExitCode{&kDoctor, "0", "nothing is wrong"},
    ExitCode{&kLooking, "0", "done"},
    ExitCode{&kAsking, "0", "done"},
    ExitCode{&kPlanning, "0", "done; check: nothing is wrong"},
    ExitCode{&kLaunch, "1 to 255",
             "the code of the mission's peer; 128 + N if it ended by signal N"},
    ExitCode{&kDoctor, "1", "there are warnings"},
    ExitCode{&kLooking, "1",
             "call: it ended with an exception that its interface declares; echo: fewer values "
             "than --count came; info: the file holds nothing; param set: the component refuses "
             "the value; decisions --replay, replay --decisions: one comes out differently"},
    ExitCode{&kDoctor, "2", "there are errors"},
    ExitCode{nullptr, "64", "the command line is wrong; nothing was done"},
    ExitCode{&kLooking, "69",
             "no service, entity or topic of that name is there, or it has gone; record: nothing "
             "was recorded"},
    ExitCode{&kLaunch, "70",
             "a process with on_loss=abort was lost: it ended, or was killed as hung, and was "
             "given up"},
    ExitCode{&kLaunch, "71",
             "something could not be started, or a process with on_loss=abort never became ready"},
    ExitCode{&kLooking, "71", "it could not join the domain, or the call failed at the other side"},
    ExitCode{&kDoctor, "71", "the system refused what it needs to look"},
    ExitCode{&kPlanning, "71", "the system refused what it needs"},
    ExitCode{&kAsking, "71",
             "the mission does not fly here, or its launcher refused or did not answer"},
    ExitCode{nullptr, "74", "the output, or a file, could not be made or written"},
    ExitCode{&kLaunch, "75",
             "all went well, but a process with on_loss=degrade was lost on the way"},
    ExitCode{&kLaunch, "76", "the mission ended by an exception, which is on stderr"},
    ExitCode{&kLaunch, "78",
             "the profile, a file or a name is wrong, there was nothing to start here, or the "
             "mission is running here already; nothing was started. Or a process with "
             "on_loss=abort, or on_loss=degrade before it was ready, ended with this code"},
    ExitCode{&kLooking, "78", "a file, a name, JSON or a parameter's value is wrong"},
    ExitCode{&kDoctor, "78", "an option or a variable of the environment is wrong"},
    ExitCode{&kAsking, "78", "the profile is wrong"},
    ExitCode{&kPlanning, "78", "the profile, a file or a name is wrong"},
    ExitCode{&kLooking, "124", "no answer came in time"},
    ExitCode{nullptr, "128 + N", "interrupted by signal N before it was done"},
};

}  // namespace skein::launch
