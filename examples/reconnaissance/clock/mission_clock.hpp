#pragma once

#include <algorithm>
#include <utility>

#include "skein/clock.hpp"
#include "ticks.hpp"

namespace reconnaissance {

/// The mission's time as a skein::Clock: it stands still between ticks, and timers run when their
/// tick begins, on the thread that begins it. Its Instant{} is the mission's beginning.
class MissionClock final : public skein::Clock {
 public:
  skein::Instant now() const override { return in_mission(clock_.now()); }

  skein::TimerId call_at(skein::Instant when, skein::Action action) override {
    return clock_.call_at(when + kOffset, std::move(action));
  }

  void cancel(skein::TimerId timer) override { clock_.cancel(timer); }

  /// Begins a tick, which must not lie before the present one: runs the timers that are due.
  void begin(Tick tick) {
    clock_.advance(std::max(skein::Duration{}, skein::Instant(time_of(tick)) - now()));
  }

 private:
  static inline const skein::Duration kOffset = skein::ManualClock().now().time_since_epoch();

  static skein::Instant in_mission(skein::Instant manual) { return manual - kOffset; }

  skein::ManualClock clock_;
};

}  // namespace reconnaissance
