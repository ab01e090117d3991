#pragma once

#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <map>
#include <memory>
#include <mutex>
#include <utility>

#include "skein/core/action.hpp"
#include "skein/core/call_memory.hpp"

namespace skein {

using Duration = std::chrono::steady_clock::duration;
using Instant = std::chrono::steady_clock::time_point;
using TimerId = std::uint64_t;

/// Where time comes from, and what wakes at a point of it. Time is an argument: only composition
/// roots make a SystemClock; tests pass a ManualClock.
class Clock {
 public:
  virtual ~Clock() = default;
  virtual Instant now() const = 0;

  /// Runs `action` once at `when` (at once where that has passed) on the clock's own thread; it
  /// must not block. Never 0.
  virtual TimerId call_at(Instant when, Action action) = 0;

  /// Forgets a timer. After it has returned the action is not running and will not run, unless
  /// called from the action itself. A timer that has run, or 0, is no error.
  virtual void cancel(TimerId timer) = 0;

  TimerId call_after(Duration delay, Action action) {
    return call_at(now() + delay, std::move(action));
  }
};

/// The machine's monotonic clock, with one thread (`skein-timer`) that runs the timers.
class SystemClock final : public Clock {
 public:
  SystemClock();
  ~SystemClock() override;
  Instant now() const override { return std::chrono::steady_clock::now(); }
  TimerId call_at(Instant when, Action action) override;
  void cancel(TimerId timer) override;

 private:
  struct State;
  std::shared_ptr<State> state_;  // also the thread's
};

/// A clock that stands still until it is told: `advance` runs what falls due, in order, on the
/// calling thread.
class ManualClock final : public Clock {
 public:
  Instant now() const override;
  TimerId call_at(Instant when, Action action) override;
  void cancel(TimerId timer) override;

  /// Moves time forward; each timer sees the instant for which it was set.
  void advance(Duration by);

 private:
  mutable std::mutex mutex_;
  Instant now_{std::chrono::hours(1)};
  TimerId last_ = 0;
  std::pmr::map<std::pair<Instant, TimerId>, Action> timers_{&call_memory()};
};

}  // namespace skein
