#pragma once

#include <sys/epoll.h>

#include <array>
#include <atomic>
#include <chrono>
#include <cstdint>
#include <mutex>
#include <optional>
#include <span>

#include "core/system/file_descriptor.hpp"

/// How one process wakes a thread of another one that sleeps until any of many connections has
/// something: by an eventfd for each connection and direction. The side that rings makes it, and
/// hands it over.
namespace skein::same_host {

/// None where the system gives no descriptor.
FileDescriptor make_doorbell() noexcept;

/// Never waits, whatever the other side does to the doorbell. Ignores a descriptor that is none.
void ring(const FileDescriptor& doorbell) noexcept;

/// Whether a descriptor that another process has handed over is a doorbell. Others could make a
/// thread that watches them wait for that process.
bool is_doorbell(const FileDescriptor& descriptor) noexcept;

/// The doorbells that a thread watches while it sleeps: one system call for each sleep, whatever
/// their number. wait() is for one thread at a time; the rest is thread-safe.
class Doorbells {
 public:
  /// `id` is what wait() returns; not 0. Throws Unavailable if the kernel refuses.
  void add(const FileDescriptor& doorbell, std::uint64_t id);
  /// Some wait() that goes on meanwhile may still return its id.
  void remove(const FileDescriptor& doorbell) noexcept;

  /// Ends a wait() early: the one that goes on, or the next one that is not after forget_call().
  void call() noexcept;
  bool called() const noexcept { return called_; }
  void forget_call() noexcept {
    if (called_) called_ = false;
  }

  /// The ids of doorbells that rang since the last time; valid until the next time. Sleeps until
  /// one rings, call(), or so long; by default for ever. It may return none.
  std::span<const std::uint64_t> wait(std::optional<std::chrono::milliseconds> longest = {});

 private:
  static constexpr int kAtOnce = 64;

  void open();

  std::mutex mutex_;  // while they are opened
  FileDescriptor epoll_;
  FileDescriptor own_;
  std::atomic<bool> called_{false};
  std::atomic<bool> sleeps_{false};
  std::array<epoll_event, kAtOnce> events_{};
  std::array<std::uint64_t, kAtOnce> rung_{};
};

}  // namespace skein::same_host
