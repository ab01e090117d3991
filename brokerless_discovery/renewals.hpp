#pragma once

#include <algorithm>
#include <mutex>
#include <utility>

#include "core/recent_set.hpp"
#include "skein/clock.hpp"
#include "skein/guid.hpp"

namespace skein::brokerless_discovery {

/// When a Broker asks everybody for all descriptions again, by a new reader (R17, R26). That costs
/// every other peer work. On a machine that has too much of it, peers lose and find each other
/// because of it: each renewal in a row waits twice as long as the last. Thread-safe.
class Renewals {
 public:
  Renewals(Duration lease, Instant now) : lease_(lease), last_(now - lease) {}

  void lost(const Guid& writer) {
    std::lock_guard lock(mutex_);
    lost_writers_.insert(writer);
  }

  /// Whether it is the first that was lost and came back since the last renewal.
  bool matched(const Guid& writer) {
    std::lock_guard lock(mutex_);
    return lost_writers_.erase(writer) && !std::exchange(writer_returned_, true);
  }

  /// Whether it is time for one; asks no second time for what has come back.
  bool take_due(Instant now, bool has_suspects) {
    constexpr int kLongestPause = 16;  // leases
    std::lock_guard lock(mutex_);
    const Duration since = now - last_;
    if (!writer_returned_ && !has_suspects) {
      if (since > 2 * pause_) pause_ = lease_;
      return false;
    }
    if (since < pause_) return false;
    pause_ = std::min(2 * pause_, kLongestPause * lease_);
    writer_returned_ = false;
    return true;
  }

  /// Whether what found no room may be asked for again.
  bool may_ask_for_room(Instant now) const {
    constexpr int kRoomPatience = 10;  // leases
    std::lock_guard lock(mutex_);
    return now - last_ >= kRoomPatience * lease_;
  }

  void renewed(Instant now) {
    std::lock_guard lock(mutex_);
    last_ = now;
  }

 private:
  const Duration lease_;
  mutable std::mutex mutex_;
  Instant last_;
  Duration pause_ = lease_;
  bool writer_returned_ = false;
  RecentSet<Guid> lost_writers_{4096};  // that may come back
};

}  // namespace skein::brokerless_discovery
