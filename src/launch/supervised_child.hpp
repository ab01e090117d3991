#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>

#include "child_process.hpp"
#include "launch/child_state.hpp"
#include "launch/supervisor.hpp"
#include "line_splitter.hpp"

namespace skein::launch {

/// One child: its state machine and its process, tied together.
class SupervisedChild {
 public:
  SupervisedChild(ChildPlan plan, const SupervisorOptions& options, GroupGuard& guard)
      : plan_(std::move(plan)), options_(options), guard_(guard), machine_(plan_.rules) {}

  void start(Time now) { perform(machine_.start(now), now); }
  void stop(Time now);
  void tick(Time now);
  /// The process, if there is one; what its descriptors say goes to the functions below.
  ChildProcess* process() const noexcept { return process_.get(); }
  void read_output();
  void read_readiness(Time now);
  void collect(Time now);

  const ChildPlan& plan() const noexcept { return plan_; }
  const ChildStateMachine& machine() const noexcept { return machine_; }
  /// How the last process ended; nothing if none was ever started.
  const std::optional<ExitStatus>& last_status() const noexcept { return last_status_; }
  /// Whether the launcher killed the last process for not becoming ready, so that its status is the
  /// launcher's doing.
  bool hung_at_start() const noexcept { return hung_at_start_; }
  /// ` (last it said: ...)`: what it waited for, if it was not ready; or empty.
  std::string last_reason() const;
  /// Why the child is lost, in one sentence; empty as long as it is not.
  const std::string& loss() const noexcept { return loss_; }

 private:
  void perform(ChildAction action, Time now);
  void spawn(Time now);
  void report(const std::string& text) const;
  void take_readiness(std::string_view bytes, Time now);
  std::string next_step() const;

  ChildPlan plan_;
  const SupervisorOptions& options_;
  GroupGuard& guard_;
  ChildStateMachine machine_;
  std::unique_ptr<ChildProcess> process_;
  LineSplitter lines_;
  Time started_{};
  std::string readiness_;  // what the process said on its pipe and is not a whole line yet
  std::string reason_;     // what it waits for
  std::optional<ExitStatus> last_status_;
  std::string loss_;
  bool hung_at_start_ = false;
};

/// `0.21 s`.
std::string seconds_text(std::chrono::nanoseconds time);

}  // namespace skein::launch
