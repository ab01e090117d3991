#pragma once

#include <chrono>
#include <deque>
#include <optional>
#include <string_view>

#include "mission/profile/restart_rules.hpp"

namespace skein::launch {

using Time = std::chrono::steady_clock::time_point;

enum class ChildState {
  Idle,         ///< Not started yet.
  Starting,     ///< The process runs, but is not ready.
  Ready,        ///< The process runs and said that it is ready.
  Interrupted,  ///< Asked to end (SIGINT).
  Terminated,   ///< Asked to end once more (SIGTERM).
  Killed,       ///< Made to end (SIGKILL); its end is on the way.
  Waiting,      ///< Ended; it will be started again.
  Ended,        ///< Ended for good, as it was meant to.
  Lost,         ///< Ended for good, and was not meant to: a failure that no restart mended.
};

/// `idle`, `starting`, ...: for messages.
std::string_view to_string(ChildState state) noexcept;

/// What the owner of a child has to do after an event.
enum class ChildAction {
  None,
  Spawn,      ///< Start the process; then report spawn_failed() or, later, exited().
  Interrupt,  ///< Send SIGINT to its group.
  Terminate,  ///< Send SIGTERM to its group.
  Kill,       ///< Send SIGKILL to its group.
};

/// Why a process was killed that nobody had asked to end.
enum class Hang {
  None,
  Start,     ///< It was not ready within its ready timeout.
  Progress,  ///< It showed no progress for its progress timeout.
};

/// When SIGTERM follows SIGINT, for a process that has `stop_timeout` in all.
std::chrono::nanoseconds time_to_terminate(std::chrono::nanoseconds stop_timeout) noexcept;

/// The life of one child of the launcher: events in, at most one action out, and time is an
/// argument. No process, no clock, no thread: the owner does what it says and reports what happens.
///
/// Its promises, whatever the order of events:
/// - Spawn only while no process runs, and never after stop();
/// - after stop(), a process that does not end is killed after the stop timeout; one that does not
///   become ready is killed after the ready timeout: no state waits for ever;
/// - only restart() leads out of Ended and Lost; an event that cannot be in a state (a stray
///   "ready") changes nothing.
class ChildStateMachine {
 public:
  explicit ChildStateMachine(profile::ProcessRules rules) : rules_(rules) {}

  ChildAction start(Time now);
  /// The process could not be started at all. `passing`: as the machine lacked something for the
  /// moment, which counts as a failure; otherwise (no such program) a restart would not help.
  ChildAction spawn_failed(bool passing, Time now);
  ChildAction ready(Time now);
  /// A sign that the process makes progress.
  ChildAction progress(Time now);
  /// The process ended; `failed` unless with exit code 0. No restart follows if it is
  /// `misconfigured`, with kConfigurationError: that would not help.
  ChildAction exited(bool failed, Time now, bool misconfigured = false);
  /// The mission ends. Asked a second time: kill at once.
  ChildAction stop(Time now);
  /// Somebody wants the process started anew, also one that was given up: its restarts are
  /// forgotten. A running one is asked to end first. Nothing before start() and after stop().
  ChildAction restart(Time now);
  /// Time went by: does what is due.
  ChildAction tick(Time now);

  /// When tick() is due, if nothing else happens before.
  std::optional<Time> next_tick() const noexcept { return due_; }

  ChildState state() const noexcept { return state_; }
  /// Ended or Lost.
  bool is_final() const noexcept;
  /// Whether a process runs, as far as was reported.
  bool is_running() const noexcept;
  /// Whether it was ready at least once.
  bool was_ready() const noexcept { return was_ready_; }
  /// Why the last process was killed by this machine, other than by stop() and restart().
  Hang hang() const noexcept { return hang_; }
  /// How often it was started again since start() or restart().
  int restarts() const noexcept { return restarts_; }

 private:
  ChildAction begin(Time now);
  ChildAction interrupt(Time now);
  ChildAction begin_anew(Time now);
  ChildAction restart_or_give_up(bool failed, bool may_help, Time now);
  ChildAction enter(ChildState state, std::optional<Time> due, ChildAction action);

  profile::ProcessRules rules_;
  ChildState state_ = ChildState::Idle;
  std::optional<Time> due_;
  std::deque<Time> recent_restarts_;
  Hang hang_ = Hang::None;
  bool stopping_ = false;
  bool restarting_ = false;  // by restart(): the running process is to make room
  bool is_sound_ = false;    // this process was ready
  bool was_ready_ = false;
  int restarts_ = 0;
};

}  // namespace skein::launch
