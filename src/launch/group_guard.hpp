#pragma once

#include <sys/types.h>

#include "../core/file_descriptor.hpp"

namespace skein::launch {

/// A small process that outlives the launcher by a moment: when the launcher dies without having
/// ended its children, the guard kills their process groups. The kernel's death signal reaches the
/// launcher's children alone, not what these have started.
class GroupGuard {
 public:
  GroupGuard();
  GroupGuard(const GroupGuard&) = delete;
  GroupGuard& operator=(const GroupGuard&) = delete;
  ~GroupGuard();

  /// Called in the child between fork and exec, so that no group is missed; async-signal-safe.
  void add(pid_t group) noexcept { send(group); }
  /// The group is gone: its number may soon be another's.
  void remove(pid_t group) noexcept { send(-group); }

 private:
  void send(pid_t message) noexcept;

  FileDescriptor groups_;
  pid_t guard_ = -1;
};

}  // namespace skein::launch
