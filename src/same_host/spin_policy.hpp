#pragma once

#include <algorithm>

#include "skein/clock.hpp"

namespace skein::same_host {

/// Whether it pays to look for the next message for a while before sleeping: it does while most
/// came soon. It spins no more once they come late.
class SpinPolicy {
 public:
  /// `limit`: how long to look at most; 0: never.
  explicit SpinPolicy(Duration limit) : limit_(limit) {}

  Duration limit() const { return limit_; }
  /// How long to look now.
  Duration budget() const { return score_ >= kEnough ? limit_ : Duration::zero(); }
  /// Something came this long after the wait for it had begun.
  void note(Duration waited) {
    score_ = waited <= limit_ ? std::min(score_ + 1, kMost) : std::max(score_ - 4, 0);
  }

 private:
  static constexpr int kMost = 16;
  static constexpr int kEnough = 8;

  Duration limit_;
  int score_ = 0;
};

}  // namespace skein::same_host
