#pragma once

#include <algorithm>
#include <chrono>
#include <functional>
#include <mutex>
#include <optional>
#include <utility>

namespace skein::dds::fastdds {

/// When a participant tells the others that its writers live. Thread-safe.
class LivelinessAssertions {
 public:
  /// `tell` tells them.
  explicit LivelinessAssertions(std::function<void()> tell) : tell_(std::move(tell)) {}

  /// Asserts from now on often enough for `lease`, too. Returns how often assert_if_due() is to be
  /// called for that.
  std::chrono::nanoseconds begin(std::chrono::nanoseconds lease) {
    const auto period = lease * 2 / 5;
    const std::lock_guard lock(mutex_);
    period_ = std::min(period_.value_or(period), period);
    return period / 4;
  }

  void assert_if_due(std::chrono::steady_clock::time_point now) {
    const std::lock_guard lock(mutex_);
    if (!period_ || now - last_ < *period_) return;
    last_ = now;
    tell_();
  }

  /// Waits for an assertion that is being sent; none is sent afterwards.
  void end() {
    const std::lock_guard lock(mutex_);
    period_.reset();
  }

 private:
  const std::function<void()> tell_;
  std::mutex mutex_;  // held while an assertion is sent
  std::optional<std::chrono::nanoseconds> period_;
  std::chrono::steady_clock::time_point last_;
};

}  // namespace skein::dds::fastdds
