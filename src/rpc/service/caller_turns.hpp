#pragma once

#include <atomic>
#include <condition_variable>
#include <cstddef>
#include <mutex>

#include "skein/clock.hpp"

namespace skein::rpc {

/// Lets calls run one at a time, each on its own thread. Thread-safe.
class CallerTurns {
 public:
  /// `clock` outlives it.
  explicit CallerTurns(Clock& clock) : clock_(clock) {}

  /// Threads that wait for their turn get none from now on.
  void close();
  /// Threads that wait for their turn.
  std::size_t awaited() const noexcept { return awaited_; }

  /// A call's turn while it exists. Without `turns` it comes at once.
  class Turn {
   public:
    /// Waits for the turn until the deadline, or until closed.
    Turn(CallerTurns* turns, Instant deadline);
    ~Turn();
    Turn(const Turn&) = delete;
    Turn& operator=(const Turn&) = delete;

    bool came() const noexcept { return came_; }
    bool waited() const noexcept { return waited_; }

   private:
    CallerTurns* const turns_;
    bool came_ = true;
    bool waited_ = false;
  };

 private:
  Clock& clock_;
  std::mutex mutex_;
  std::condition_variable ended_;
  bool taken_ = false;
  bool closed_ = false;
  std::atomic<std::size_t> awaited_{0};
};

}  // namespace skein::rpc
