#pragma once

#include <sys/types.h>

#include <optional>
#include <string>

#include "core/system/file_descriptor.hpp"
#include "mission/process/group_guard.hpp"
#include "mission/supervise/launch_plan.hpp"

namespace skein::launch {

/// How a process ended, as wait(2) tells it.
struct ExitStatus {
  bool by_signal = false;
  int number = 0;  ///< Exit code or signal.

  bool failed() const noexcept { return by_signal || number != 0; }
  /// 128 + N for signal N, as shells have it.
  int exit_code() const noexcept { return by_signal ? 128 + number : number; }
};

/// `with exit code 3`, `by signal 11 (Segmentation fault)`.
std::string to_text(const ExitStatus& status);

/// A running process that leads a process group of its own. All that it starts goes with it: what
/// is in its group, and what has left it but bears its mark (see kMarkVariable).
class ChildProcess {
 public:
  /// Starts the program. Throws Unavailable with the reason if it cannot be executed.
  ChildProcess(const ChildPlan& plan, GroupGuard& guard);
  ChildProcess(const ChildProcess&) = delete;
  ChildProcess& operator=(const ChildProcess&) = delete;
  /// Kills all that is still there.
  ~ChildProcess();

  pid_t id() const noexcept { return id_; }
  /// Becomes readable when the process has ended.
  int end_descriptor() const noexcept { return end_.get(); }
  /// The output of the group, non-blocking.
  FileDescriptor& output() noexcept { return output_; }
  /// Where the process says that it is ready and makes progress, non-blocking.
  FileDescriptor& readiness() noexcept { return readiness_; }

  void send(int signal) const noexcept;  ///< To the whole group.
  /// The status if the process has ended; what it started is killed and gone then.
  std::optional<ExitStatus> collect();

 private:
  void start(const ChildPlan& plan);
  void end_group() noexcept;

  GroupGuard& guard_;
  const std::string mark_;
  pid_t id_ = -1;
  FileDescriptor end_;
  FileDescriptor output_;
  FileDescriptor readiness_;
};

}  // namespace skein::launch
