#pragma once

#include <atomic>
#include <chrono>
#include <functional>

namespace skein::dds::fastdds {

/// Silence after a sleep. A participant that sent nothing for its whole lease has been forgotten by
/// the others, and finds their old messages waiting while it still knows them: what it answers from
/// memory, they take for what they never said. So it neither hears nor speaks until it has
/// forgotten them, too. One that was merely busy has sent something meanwhile: it announces itself
/// several times in a lease. Thread-safe.
class SuspendDetector {
 public:
  using Time = std::chrono::steady_clock::time_point;

  explicit SuspendDetector(std::chrono::nanoseconds lease) : lease_(lease) {}

  /// Called, once a sleep, on the thread of the first message after it; is to see to it that all
  /// are forgotten and awake() called. To be set before any message.
  std::function<void()> on_wake;

  /// Whether a message may go now; notes that it does.
  bool may_send(Time now) {
    if (sleeps(now)) return false;
    last_sent_.store(now.time_since_epoch().count(), std::memory_order_relaxed);
    return true;
  }
  bool may_receive(Time now) { return !sleeps(now); }

  void awake(Time now) {
    last_sent_ = now.time_since_epoch().count();
    asleep_ = false;
  }

 private:
  bool sleeps(Time now) {
    if (asleep_) return true;
    const auto last = last_sent_.load(std::memory_order_relaxed);
    if (last == 0 || now.time_since_epoch().count() - last <= lease_.count()) return false;
    if (!asleep_.exchange(true) && on_wake) on_wake();
    return true;
  }

  const std::chrono::nanoseconds lease_;
  std::atomic<bool> asleep_{false};
  std::atomic<std::chrono::steady_clock::rep> last_sent_{0};  // or 0
};

}  // namespace skein::dds::fastdds
