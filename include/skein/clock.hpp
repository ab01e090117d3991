#pragma once

#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <map>
#include <memory>
#include <mutex>
#include <thread>
#include <type_traits>
#include <utility>

#include "skein/detail/action.hpp"
#include "skein/detail/call_memory.hpp"

namespace skein {

using Duration = std::chrono::steady_clock::duration;
using Instant = std::chrono::steady_clock::time_point;
using TimerId = std::uint64_t;

/// The sum, or the end of Duration's range if it lies beyond: users and peers may give any
/// duration, also Duration::max().
constexpr Duration saturating_sum(Duration a, Duration b) noexcept {
  Duration::rep sum = 0;
  if (!__builtin_add_overflow(a.count(), b.count(), &sum)) return Duration(sum);
  return b < Duration::zero() ? Duration::min() : Duration::max();
}
/// The duration, or the end of Duration's range if it lies beyond, as milliseconds::max() does.
template <class Rep, class Period>
constexpr Duration saturating_duration(const std::chrono::duration<Rep, Period>& time) noexcept {
  using Wide = std::chrono::duration<double>;
  if (Wide(time) >= Wide(Duration::max())) return Duration::max();
  if (Wide(time) <= Wide(Duration::min())) return Duration::min();
  return std::chrono::duration_cast<Duration>(time);
}

/// A Duration that is made of any other by saturating_duration(), and that refuses a number without
/// a unit in words.
struct TimeSpan : Duration {
  constexpr TimeSpan() noexcept : Duration(zero()) {}
  constexpr TimeSpan(Duration time) noexcept : Duration(time) {}
  template <class Rep, class Period>
  requires(std::is_convertible_v<std::chrono::duration<Rep, Period>, Duration>) constexpr TimeSpan(
      const std::chrono::duration<Rep, Period>& time) noexcept
      : Duration(saturating_duration(time)) {}
  template <class Number>
  requires(std::is_arithmetic_v<Number>) TimeSpan(Number) {
    static_assert(std::is_void_v<Number>,
                  "a time has a unit: write 5s or 200ms, with `using namespace "
                  "std::chrono_literals`");
  }
};

/// Likewise; no clock reaches Instant::max().
constexpr Instant saturating_sum(Instant from, TimeSpan by) noexcept {
  return Instant(saturating_sum(from.time_since_epoch(), by));
}

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

  /// The time in `delay` from now; never, Instant::max(), if that lies beyond the range.
  Instant after(TimeSpan delay) const { return saturating_sum(now(), delay); }

  TimerId call_after(TimeSpan delay, Action action) {
    return call_at(after(delay), std::move(action));
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
/// order, on the calling thread. A thread that waits for a deadline, as in a blocking call whose
/// reply was lost, waits until another thread calls advance().
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
