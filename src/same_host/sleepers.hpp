#pragma once

#include <chrono>
#include <functional>
#include <optional>
#include <utility>

#include "skein/clock.hpp"

namespace skein::same_host {

/// Clients that have their answers, and are let sleep by the thread that answers, on their core:
/// one that is woken has its turn at once, while the next request waits. They are woken together,
/// as a rule after 50 us of calls at most. For one thread.
class Sleepers {
 public:
  /// `replaced`: whether another thread has gone on in this one's place, and wakes them.
  explicit Sleepers(std::function<bool()> replaced) : replaced_(std::move(replaced)) {}

  /// A call begins after which there are more.
  void note_call() {
    if (!last_) last_ = std::chrono::steady_clock::now();
  }
  /// Makes the client of that call one of them; false where the call took long, or one of them has
  /// slept for long.
  bool add() {
    if (!last_) return false;
    const Instant now = std::chrono::steady_clock::now();
    const bool quick = now - *last_ < kMost;
    if (!any_) since_ = now;
    const bool added = quick && now - since_ < kMost;
    any_ = any_ || added;
    last_.reset();  // a client that is woken now runs before the next call does
    if (added) last_ = now;
    return added;
  }
  bool any() const { return any_; }
  /// Whether one has slept for long.
  bool due() const { return any_ && std::chrono::steady_clock::now() - since_ >= kMost; }
  bool replaced() const { return replaced_(); }
  /// They have been woken.
  void clear() {
    any_ = false;
    last_.reset();
  }

 private:
  static constexpr std::chrono::microseconds kMost{50};

  const std::function<bool()> replaced_;
  bool any_ = false;
  Instant since_;
  std::optional<Instant> last_;  // when the last call ended, or this one began
};

}  // namespace skein::same_host
