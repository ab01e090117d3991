#pragma once

#include <sys/types.h>

#include <string>

#include "core/system/file_descriptor.hpp"

namespace skein::launch {

/// A small process that outlives the launcher by a moment: when the launcher dies without having
/// ended its children, the guard kills their process groups, and what has left them but bears the
/// launcher's mark. The kernel's death signal reaches the launcher's children alone, not what these
/// have started.
class GroupGuard {
 public:
  /// Throws SystemError if there can be no guard.
  GroupGuard();
  GroupGuard(const GroupGuard&) = delete;
  GroupGuard& operator=(const GroupGuard&) = delete;
  ~GroupGuard();

  /// Called in the child between fork and exec, so that no group is missed; async-signal-safe.
  void add(pid_t group) noexcept { send(group); }
  /// The group is gone: its number may soon be another's.
  void remove(pid_t group) noexcept { send(-group); }
  /// A mark for the environment of one more process (see kMarkVariable), which holds the
  /// launcher's.
  std::string next_mark() { return mark_ + "." + std::to_string(++marks_) + "."; }

 private:
  void send(pid_t message) noexcept;
  void end() noexcept;

  const std::string mark_;
  std::size_t marks_ = 0;
  FileDescriptor groups_;
  pid_t guard_ = -1;
};

}  // namespace skein::launch
