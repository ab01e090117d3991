#pragma once

#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <map>
#include <memory>
#include <mutex>
#include <thread>
#include <utility>

#include "skein/detail/action.hpp"
#include "skein/detail/call_memory.hpp"

namespace skein {

using Duration = std::chrono::steady_clock::duration;
using Instant = std::chrono::steady_clock::time_point;
using TimerId = std::uint64_t;

/// Source of time and timers. Time is an argument: only composition roots make a SystemClock; tests
/// pass a ManualClock. Thread-safe.
class Clock {
 public:
  virtual ~Clock() = default;
  virtual Instant now() const = 0;

  /// Runs `action` once at `when`, or as soon as possible if that has passed: SystemClock on its
  /// own thread, ManualClock in advance(). The action must neither block nor throw. Returns the
  /// timer's number, never 0.
  virtual TimerId call_at(Instant when, Action action) = 0;

  /// Cancels a timer. After this returns, the action is not running and will not run, unless the
  /// action itself makes this call. Cancelling 0, or a timer that has run, is no error.
  virtual void cancel(TimerId timer) = 0;

  TimerId call_after(Duration delay, Action action) {
    return call_at(now() + delay, std::move(action));
  }
};

/// The machine's monotonic clock. One thread (`skein-timer`) runs the timers. Timers that are left
/// when it is destroyed do not run.
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

/// A clock that stands still until advance() is called, which runs the timers that are due, in
/// order, on the calling thread.
class ManualClock final : public Clock {
 public:
  Instant now() const override;
  TimerId call_at(Instant when, Action action) override;
  void cancel(TimerId timer) override;

  /// Moves time forward. Each action sees the instant for which its timer was set.
  void advance(Duration by);

 private:
  mutable std::mutex mutex_;
  std::condition_variable finished_;              // an action has returned
  std::map<TimerId, std::thread::id> running_{};  // and the thread that runs it
  Instant now_{std::chrono::hours(1)};
  TimerId last_ = 0;
  std::pmr::map<std::pair<Instant, TimerId>, Action> timers_{&call_memory()};
};

}  // namespace skein
