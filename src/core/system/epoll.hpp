#pragma once

#include <sys/epoll.h>

#include <chrono>
#include <cstdint>
#include <vector>

#include "file_descriptor.hpp"

namespace skein {

/// Descriptors of which one thread waits for events. Each has a number that is never used again, as
/// descriptors are. Another thread may wait while one adds or removes; otherwise not thread-safe.
class Epoll {
 public:
  struct Event {
    std::uint64_t id;
    std::uint32_t events;
  };

  /// False, with errno, if the kernel gave none.
  explicit operator bool() const noexcept { return static_cast<bool>(epoll_); }
  /// Readable if wait() would return events.
  int descriptor() const noexcept { return epoll_.get(); }

  /// Returns the descriptor's number, or 0, with errno, if the kernel refuses.
  std::uint64_t add(const FileDescriptor& of, std::uint32_t events) {
    return control(EPOLL_CTL_ADD, of, last_id_ + 1, events) ? ++last_id_ : 0;
  }

  void change(const FileDescriptor& of, std::uint64_t id, std::uint32_t events) {
    control(EPOLL_CTL_MOD, of, id, events);
  }

  /// To be called before the descriptor is closed: if a forked child has a copy, the kernel would
  /// report its events for as long as the child lives.
  void remove(const FileDescriptor& of) { control(EPOLL_CTL_DEL, of, 0, 0); }

  /// Returns no events if none comes in time, or a signal interrupts it.
  std::vector<Event> wait(std::chrono::milliseconds most) const {
    epoll_event events[32];
    const int count = epoll_wait(epoll_.get(), events, 32, static_cast<int>(most.count()));
    std::vector<Event> result;
    for (int i = 0; i < count; ++i) result.push_back({events[i].data.u64, events[i].events});
    return result;
  }

 private:
  bool control(int operation, const FileDescriptor& of, std::uint64_t id, std::uint32_t events) {
    epoll_event event{};
    event.events = events;
    event.data.u64 = id;
    return epoll_ctl(epoll_.get(), operation, of.get(), &event) == 0;
  }

  FileDescriptor epoll_{epoll_create1(EPOLL_CLOEXEC)};
  std::uint64_t last_id_ = 0;
};

}  // namespace skein
