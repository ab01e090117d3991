#pragma once

#include <sys/types.h>

#include <cstddef>
#include <cstdint>
#include <unordered_map>

#include "core/system/epoll.hpp"

namespace skein::brokerless_discovery {

/// The connections of processes that watch this one. Not thread-safe.
class Watchers {
 public:
  /// `epoll` outlives this object.
  explicit Watchers(Epoll& epoll) : epoll_(epoll) {}
  Watchers(const Watchers&) = delete;
  Watchers& operator=(const Watchers&) = delete;

  /// Greets the process, and moves from the socket, if it may watch this one.
  void greet(FileDescriptor& socket, pid_t process);

  /// Forgets the watcher that has hung up; returns false if the event is none of a watcher's.
  bool handle(std::uint64_t event);

  std::size_t count() const noexcept { return watchers_.size(); }

 private:
  struct Watcher {
    pid_t process;
    FileDescriptor socket;
  };

  Epoll& epoll_;
  std::unordered_map<std::uint64_t, Watcher> watchers_;
  std::unordered_map<pid_t, std::size_t> of_process_;  // how many; only those that have some
};

}  // namespace skein::brokerless_discovery
