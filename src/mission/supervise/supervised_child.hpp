#pragma once

#include <memory>
#include <optional>
#include <string>

#include "child_process.hpp"
#include "mission/process/line_splitter.hpp"
#include "mission/supervise/child_state.hpp"
#include "mission/supervise/supervisor.hpp"
#include "skein/mission_status.idl.hpp"

namespace skein::launch {

/// What a process said on its pipe since it was last asked.
struct Signs {
  bool ready = false;
  bool progress = false;
};

/// One child's process, and all that is told of it. When something is to be done, its state machine
/// says, which a MissionState owns.
class SupervisedChild {
 public:
  /// `machine` outlives this object.
  SupervisedChild(ChildPlan plan, const ChildStateMachine& machine,
                  const SupervisorOptions& options, GroupGuard& guard)
      : plan_(std::move(plan)), options_(options), guard_(guard), machine_(machine) {}

  /// Starts the process; false where that fails.
  bool spawn(Time now);
  /// Whether what spawn() failed for may be there a moment later.
  bool spawn_may_succeed_later() const noexcept { return spawn_may_succeed_later_; }
  /// `overdue`: because time ran out, not because somebody asked.
  void send(ChildAction action, bool overdue);
  /// The process, if there is one; what its descriptors say goes to the functions below.
  ChildProcess* process() const noexcept { return process_.get(); }
  void read_output();
  Signs read_signs();
  /// How the process ended, once it has; its last signs can still be read. tell_end() must follow.
  std::optional<ExitStatus> collect();

  /// These tell what the machine has made of an event, and come after it.
  void tell_ready(Time now);
  void tell_spawn_failed();
  /// `a could not be started: ...`.
  std::string spawn_fault() const;
  void tell_end();

  const ChildPlan& plan() const noexcept { return plan_; }
  /// How the last process ended; nothing if none was ever started.
  const std::optional<ExitStatus>& last_status() const noexcept { return last_status_; }
  /// Whether the last process ended with kConfigurationError, which a restart does not mend.
  bool is_misconfigured() const noexcept {
    return last_status_ && last_status_->exit_code() == kConfigurationError;
  }
  /// ` (last it said: ...)`: what it waited for, if it was not ready; or empty.
  std::string last_reason() const;
  /// `ended by signal 9 (Killed)`, `did not become ready`: the last process's end.
  std::string end_text() const;
  /// Why the child is lost, in one sentence; empty as long as it is not.
  const std::string& loss() const noexcept { return loss_; }
  ProcessStatus status(Time now) const;

 private:
  void report(const std::string& text) const;
  void take_signs(std::string_view bytes, Signs& signs);
  std::string given_up() const;
  std::string next_step() const;

  ChildPlan plan_;
  const SupervisorOptions& options_;
  GroupGuard& guard_;
  const ChildStateMachine& machine_;
  std::unique_ptr<ChildProcess> process_;
  LineSplitter lines_;
  Time started_{};
  std::string signs_;   // what the process said on its pipe and is not a whole line yet
  std::string reason_;  // what it waits for
  bool said_ready_ = false;
  std::string spawn_error_;
  bool spawn_may_succeed_later_ = false;
  std::optional<ExitStatus> last_status_;
  std::string loss_;
};

/// `0.21 s`, and what is shorter than that shows as `1.5 ms`.
std::string seconds_text(std::chrono::nanoseconds time);

}  // namespace skein::launch
