#pragma once

#include <algorithm>
#include <chrono>
#include <cstdint>

namespace skein::dds {

/// How much of something may be taken: so much at once, and what each second adds up to that again.
/// A value.
class Allowance {
 public:
  using Time = std::chrono::steady_clock::time_point;

  struct Rate {
    std::int64_t at_once;
    std::int64_t a_second;
  };

  explicit Allowance(Rate rate) : rate_(rate), left_(rate.at_once) {}

  /// How much is there now. Time that goes back adds nothing.
  std::int64_t left(Time now) {
    const auto since = std::chrono::duration<double>(now - filled_).count();
    const double full = static_cast<double>(rate_.at_once - left_);
    const double more = since * static_cast<double>(rate_.a_second);
    if (more >= full) {
      left_ = rate_.at_once;
      filled_ = now;
    } else if (more >= 1) {
      left_ += static_cast<std::int64_t>(more);
      filled_ = now;
    }
    return left_;
  }

  /// No more than is there.
  void take(std::int64_t amount) { left_ -= amount; }

 private:
  Rate rate_;
  std::int64_t left_;
  Time filled_{};
};

}  // namespace skein::dds
