#pragma once

#include <functional>
#include <memory>
#include <string>
#include <string_view>

#include "mission/process/exit_codes.hpp"
#include "mission/supervise/child_state.hpp"
#include "mission/supervise/launch_plan.hpp"

namespace skein::launch {

class RequestServer;

struct LaunchResult {
  /// One of kExitCodes. 0 only if the mission's peer ended with 0 by itself (without such a peer:
  /// if all processes ended as they were meant to). Its own code if it ended with another, 128 + N
  /// if by signal N.
  int exit_code = 0;
  std::string reason;  ///< Why the mission ended, in one sentence.
  /// What went wrong first, and when, where that is not `reason` itself; or empty.
  std::string first_fault;
};

/// Something that happened, for whoever shows it.
struct ChildEvent {
  std::string child;  ///< Empty for the mission as a whole.
  ChildState state = ChildState::Idle;
  std::string text;  ///< For people, such as `ready after 0.21 s` or `ended by signal 11 (...)`.
};

struct SupervisorOptions {
  /// A line of a child's output, without its line break.
  std::function<void(std::string_view child, std::string_view line)> on_output =
      [](std::string_view, std::string_view) {};
  std::function<void(const ChildEvent& event)> on_event = [](const ChildEvent&) {};
  /// Takes requests (see MissionClaim) while run() runs: `status`, answered by a MissionStatus as
  /// JSON; `lines`, by MissionLines; `restart PROCESS`; `stop`; and, to try what the mission bears,
  /// `kill PROCESS` and `hang PROCESS`. Null: there are none.
  RequestServer* requests = nullptr;
};

/// Runs the processes of a mission on this host: starts each when what it waits for is ready, shows
/// their output, watches them become ready and make progress, restarts those that fail by their
/// rules, and ends the mission when its peer ends, a process is lost that must not be, or it is
/// told to. What follows from what is MissionState's to say.
///
/// Each process leads a process group of its own. Ending goes group by group: SIGINT, SIGTERM,
/// SIGKILL within the stop timeout; when run() returns, none of the groups is left, nor what has
/// left them for a session of its own. When the launcher itself is killed, the kernel kills its
/// children, and a guard process all that they have started.
///
/// Orphans below this process become its children, as they do of PID 1. run() reaps them when they
/// end, and kills those that are left when the mission has ended. This process starts no children
/// of its own meanwhile.
///
/// If a process was started without its parent's environment and has left its group, it lives on
/// until the mission ends, and beyond a killed launcher. Processes of another user are not reached.
///
/// Children belong to the thread that calls run(); it calls back `on_output` and `on_event`, and
/// makes no other thread.
class Supervisor {
 public:
  explicit Supervisor(LaunchPlan plan, SupervisorOptions options = {});
  ~Supervisor();
  Supervisor(const Supervisor&) = delete;
  Supervisor& operator=(const Supervisor&) = delete;

  /// Runs the mission to its end; once only. Ends it in order on SIGINT, SIGTERM and SIGHUP; a
  /// second one kills at once, unless it is the same and comes within 300 ms. The signals are
  /// blocked in the calling thread meanwhile; other threads must block them, too. Throws
  /// Unavailable if the operating system refuses what the launcher itself needs (pipes, its guard);
  /// nothing is left running then.
  LaunchResult run();

  /// Ends the mission in order, from any thread or signal handler; before run() as well.
  void request_stop() noexcept;

 private:
  struct State;
  const std::unique_ptr<State> state_;
};

}  // namespace skein::launch
