#pragma once

#include <algorithm>
#include <cstdint>
#include <map>
#include <optional>

#include "skein/clock.hpp"
#include "ticks.hpp"

namespace reconnaissance {

/// Which ticks a participant may acknowledge: those whose work is done, while nobody holds time up.
/// A pure object; instants are the system clock's.
///
/// A *hold* is for work that takes time in the mission, too, such as planning a route: while it
/// lasts, the mission's time may advance by as much as the work has taken so far, and no more;
/// where the latency is known before (replayed from a recording), by that latency.
class Participation {
 public:
  using Hold = std::uint64_t;

  explicit Participation(int period) : period_(period) {}

  int period() const { return period_; }
  /// The last tick whose work is done; -1: none.
  Tick done() const { return done_; }
  void finish(Tick tick) { done_ = tick; }

  /// Begins a hold at the mission's present time, the tick `now`.
  Hold hold(Tick now, skein::Instant system_now,
            std::optional<skein::Duration> latency = std::nullopt) {
    holds_.emplace(++last_hold_, Held{time_of(now), system_now, latency});
    return last_hold_;
  }

  void release(Hold hold) { holds_.erase(hold); }

  /// The last tick that may be acknowledged at that instant; -1: none. After its acknowledgment
  /// time passes to the tick before the next that is due here: each hold must allow all of that. So
  /// a hold that begins after the present tick was acknowledged takes hold at the next.
  Tick acknowledge(skein::Instant system_now) {
    if (const auto free = freed(); !free || *free <= system_now) acknowledged_ = done_;
    return acknowledged_;
  }

  /// When more may be acknowledged by the passing of time; nothing if that waits for work, or for a
  /// release.
  std::optional<skein::Instant> next_change() const {
    if (acknowledged_ == done_) return std::nullopt;
    const auto free = freed();
    return free == skein::Instant::max() ? std::nullopt : free;
  }

 private:
  struct Held {
    skein::Duration began;  // in the mission
    skein::Instant system_began;
    std::optional<skein::Duration> latency;
  };

  /// When all holds allow that the last finished tick is acknowledged; nothing if there are none,
  /// and Instant::max() if one waits for its release.
  std::optional<skein::Instant> freed() const {
    const skein::Duration passes_to = time_of(done_ + period_ - 1);
    std::optional<skein::Instant> free;
    for (const auto& [hold, held] : holds_) {
      const skein::Duration needed = passes_to - held.began;
      skein::Instant when = held.system_began + needed;
      if (held.latency) when = needed <= *held.latency ? skein::Instant{} : skein::Instant::max();
      free = std::max(free.value_or(when), when);
    }
    return free;
  }

  int period_;
  Tick done_ = -1;
  Tick acknowledged_ = -1;
  Hold last_hold_ = 0;
  std::map<Hold, Held> holds_;
};

}  // namespace reconnaissance
