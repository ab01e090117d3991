#pragma once

#include <functional>
#include <memory>
#include <string>
#include <string_view>

#include "launch/child_state.hpp"
#include "launch/launch_plan.hpp"

namespace skein::launch {

enum class Outcome {
  MissionEnded,  ///< The peer that runs the mission ended by itself, or all processes did.
  StartFailed,   ///< A required process could not be started, or never became ready.
  PeerLost,      ///< A required process was ready once, ended, and was not mended by restarts.
  Interrupted,   ///< SIGINT, SIGTERM, SIGHUP or request_stop().
};

/// Exit codes of a launcher. They are those of sysexits.h and of the shell, so that they do not
/// meet the small numbers that missions end with.
inline constexpr int kConfigurationError = 78;  ///< For the caller: nothing was started.
inline constexpr int kPeerLost = 70;
inline constexpr int kStartFailed = 71;
inline constexpr int kOutputLost = 74;     ///< For the caller: stdout could not be written.
inline constexpr int kMissionFailed = 76;  ///< Of a peer: its mission ended by an exception.
inline constexpr int kInterrupted = 128;   ///< Plus the signal's number.

struct LaunchResult {
  Outcome outcome = Outcome::MissionEnded;
  /// 0 only if the mission's peer ended with 0 by itself (without such a peer: if all processes
  /// ended as they were meant to). Its own code if it ended with another, 128 + N if by signal N.
  int exit_code = 0;
  std::string reason;  ///< The first cause, in one sentence.
};

/// Something that happened, for whoever shows it.
struct ChildEvent {
  std::string child;  ///< Empty for the mission as a whole.
  ChildState state = ChildState::Idle;
  std::string text;  ///< For people, such as `ready after 0.21 s` or `ended by signal 11 (...)`.
};

struct SupervisorOptions {
  /// A line of a child's output, without its line break; by default `name | line` on stdout.
  std::function<void(std::string_view child, std::string_view line)> on_output;
  /// By default `name | * text` on stderr.
  std::function<void(const ChildEvent& event)> on_event;
  /// Whether run() ends the mission in order on SIGINT, SIGTERM and SIGHUP; a second one kills at
  /// once. The signals are blocked in the calling thread while run() lasts; other threads of the
  /// process must block them, too.
  bool handle_signals = true;
};

/// Runs the processes of a mission on this host: starts them all at once, shows their output,
/// watches them become ready, restarts those that fail by their rules, and ends the mission when
/// its peer ends, a required process is lost, or it is told to.
///
/// Each process leads a process group of its own. Ending goes group by group: SIGTERM, the stop
/// timeout, SIGKILL; when run() returns, none of the groups is left. When the launcher itself is
/// killed, the kernel kills its children, and a guard process the rest of their groups.
///
/// Children belong to the thread that calls run(); it calls back `on_output` and `on_event`, and
/// makes no other thread.
class Supervisor {
 public:
  explicit Supervisor(LaunchPlan plan, SupervisorOptions options = {});
  ~Supervisor();
  Supervisor(const Supervisor&) = delete;
  Supervisor& operator=(const Supervisor&) = delete;

  /// Runs the mission to its end; once only. Throws Unavailable if the operating system refuses
  /// what the launcher itself needs (pipes, its guard); nothing is left running then.
  LaunchResult run();

  /// Ends the mission in order, from any thread or signal handler; before run() as well.
  void request_stop() noexcept;

 private:
  class Implementation;
  std::unique_ptr<Implementation> implementation_;
};

}  // namespace skein::launch
