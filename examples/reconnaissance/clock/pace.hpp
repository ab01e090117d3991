#pragma once

#include <algorithm>
#include <optional>

#include "skein/clock.hpp"
#include "ticks.hpp"

namespace reconnaissance {

/// How fast the mission's time may advance where nobody holds it up: paused, in single steps, or up
/// to so many times as fast as real time. A pure object; instants are the system clock's.
class Pace {
 public:
  /// 0: as fast as it can.
  explicit Pace(double times_real_time = 0) : limit_(times_real_time) {}

  void pause() { steps_ = 0; }
  void resume() { steps_.reset(); }
  /// Pauses after so many more ticks.
  void step(std::uint64_t ticks) { steps_ = steps_.value_or(0) + ticks; }
  void limit(double times_real_time) { limit_ = times_real_time; }

  bool paused() const { return steps_ == 0u; }
  double limit() const { return limit_; }

  /// When the next tick may begin; nothing while time is paused. What is late is made up for by no
  /// more than kCatchUp.
  std::optional<skein::Instant> next() const {
    if (paused()) return std::nullopt;
    return next_;
  }

  /// A tick begins.
  void begin(skein::Instant now) {
    constexpr skein::Duration kCatchUp = std::chrono::milliseconds(100);
    if (steps_ && *steps_ > 0) --*steps_;
    const auto interval = limit_ > 0 ? std::chrono::duration_cast<skein::Duration>(
                                           std::chrono::duration<double>(kTick) / limit_)
                                     : skein::Duration{};
    next_ = std::max(next_, now - kCatchUp) + interval;
  }

 private:
  double limit_;
  std::optional<std::uint64_t> steps_;  // unset: it runs freely
  skein::Instant next_{};
};

}  // namespace reconnaissance
