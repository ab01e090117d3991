#pragma once

#include <sys/types.h>

#include <atomic>
#include <chrono>
#include <cstdint>
#include <functional>
#include <map>
#include <mutex>
#include <string>
#include <vector>

#include "skein/clock.hpp"

namespace skein {

class StallWatch;

/// One of the library's own threads whose work comes in short pieces. The log tells of a
/// piece that takes more than a second, while somebody looks (StallWatch::look).
class WatchedThread {
 public:
  /// Of the calling thread, which also destroys it.
  explicit WatchedThread(std::string name);
  WatchedThread(std::string name, StallWatch& watch);
  ~WatchedThread();
  WatchedThread(const WatchedThread&) = delete;
  WatchedThread& operator=(const WatchedThread&) = delete;

  /// Around each piece, in turn. Costs a store.
  void begin() noexcept { step(); }
  void end() noexcept { step(); }

 private:
  friend class StallWatch;

  void step() noexcept {
    steps_.store(steps_.load(std::memory_order_relaxed) + 1, std::memory_order_relaxed);
  }

  const std::string name_;
  const pid_t thread_;
  StallWatch& watch_;
  std::atomic<std::uint64_t> steps_{0};  // odd: within a piece
};

/// Finds stalled threads, by looking twice a second whether a thread is still within the piece
/// of work that it was in: threads need no clock. What counts is looks, not time, so that a process
/// that was stopped, and a clock that has jumped, look like nobody's stall. Thread-safe.
class StallWatch {
 public:
  static constexpr std::chrono::milliseconds kPeriod{500};
  /// A thread that is in the same piece so many looks after the first has stalled.
  static constexpr int kLooks = 2;
  /// So long nothing further is told of a thread that was told of: a minute.
  static constexpr int kQuietLooks = 120;

  using Tell = std::function<void(const std::string& name, pid_t thread)>;

  explicit StallWatch(Tell tell);

  /// Of all threads of this process. Writes to the log.
  static StallWatch& of_this_process();

  /// Looks, if the last look was kPeriod ago. Returns how long it is until the next one. For
  /// threads that never block; several may call it.
  std::chrono::milliseconds look(Instant now);

 private:
  friend class WatchedThread;

  struct Seen {
    std::uint64_t steps = 0;
    int looks = 0;
    int quiet = 0;
  };

  struct Stalled {
    std::string name;
    pid_t thread;
  };

  std::chrono::milliseconds look(Instant now, std::vector<Stalled>& stalled);
  static bool has_stalled(const WatchedThread& thread, Seen& seen, bool anew);

  const Tell tell_;
  std::mutex mutex_;
  Instant last_{};
  std::map<const WatchedThread*, Seen> threads_;
};

}  // namespace skein
