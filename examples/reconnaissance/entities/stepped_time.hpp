#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <mutex>
#include <vector>

#include "clock/ticks.hpp"
#include "skein/clock.hpp"

namespace reconnaissance {

/// The clock of a process in which all participants of a mission live, and in which the caller of
/// step() makes the mission's time: each participant works on that thread, one after the other, so
/// no tick needs a message. As a clock it is the system's. Thread-safe.
class SteppedTime final : public skein::Clock {
 public:
  using Work = std::function<void(Tick)>;

  /// The participant works in each tick that `period` divides, after those that joined before it.
  /// Returns its number, for leave().
  std::size_t join(int period, Work work);
  /// After this returns, the participant does not work, and will not.
  void leave(std::size_t number);
  std::size_t participants() const;

  /// Lets a tick pass: all that are due work.
  void step();

  skein::Instant now() const override { return system_.now(); }
  skein::TimerId call_at(skein::Instant when, skein::Action action) override {
    return system_.call_at(when, std::move(action));
  }
  void cancel(skein::TimerId timer) override { system_.cancel(timer); }

 private:
  struct Member {
    int period;
    Work work;
  };

  skein::SystemClock system_;
  mutable std::mutex mutex_;  // held while a participant works
  std::map<std::size_t, Member> members_;
  std::size_t last_ = 0;
  Tick tick_ = -1;
};

}  // namespace reconnaissance
