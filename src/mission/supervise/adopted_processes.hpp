#pragma once

#include <sys/types.h>

#include <csignal>
#include <functional>
#include <vector>

namespace skein::launch {

/// While it lives, this process is the parent of every orphan among the processes below it, as PID
/// 1 is in a container. Such an orphan has lost its parent, and nobody else reaps it when it ends.
///
/// There is one of these at a time, since it handles SIGCHLD.
class AdoptedProcesses {
 public:
  /// The children that this process has by now do not count as adopted. Throws SystemError if the
  /// kernel gives no descriptor.
  AdoptedProcesses();
  AdoptedProcesses(const AdoptedProcesses&) = delete;
  AdoptedProcesses& operator=(const AdoptedProcesses&) = delete;
  /// Kills and reaps all that were adopted, and those that come here meanwhile. This process must
  /// not wait for any child of its own by then. Does not reach processes of another user.
  ~AdoptedProcesses();

  /// Becomes readable when a child has ended.
  int descriptor() const noexcept;

  /// Reaps each child that has ended, but for those that `is_awaited` names. It stops at the first
  /// of these: call again when that one has been waited for.
  void reap(const std::function<bool(pid_t)>& is_awaited) noexcept;

 private:
  void end();

  std::vector<pid_t> earlier_;
  int adopted_before_ = 0;
  sigset_t mask_before_{};
  struct sigaction action_before_ {};
};

}  // namespace skein::launch
