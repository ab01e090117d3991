#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "mission/supervise/child_state.hpp"

namespace skein::launch {

/// What a launcher that is attended by another one tells it: one line of printable text each.
struct AttendedReport {
  enum class Kind {
    Hello,   ///< First of all: `text` is the hello, which both sides must agree on.
    Output,  ///< `child` has written the line `text`.
    Event,   ///< What happened to `child`, which is in `state` now; see ChildEvent.
    Ready,   ///< All processes are ready.
    Ended,   ///< Last of all: the exit code, and why.
  };

  Kind kind = Kind::Event;
  std::string child{};  ///< Empty for all of them.
  ChildState state = ChildState::Idle;
  int exit_code = 0;
  std::string text{};
};

/// What the attending launcher tells: a line each, and one of kAlive at least every kHeartbeat.
inline constexpr std::string_view kGo = "go";        ///< The hello is accepted: start.
inline constexpr std::string_view kAlive = "alive";  ///< The mission goes on.
inline constexpr std::string_view kStop = "stop";    ///< End everything in order.

/// With a line break. Of a longer text the beginning goes, so that the line stays one that
/// LineSplitter takes.
std::string to_line(const AttendedReport& report);

/// The report in a line; nothing where it is none, but text of somebody else.
std::optional<AttendedReport> maybe_report(std::string_view line);

}  // namespace skein::launch
