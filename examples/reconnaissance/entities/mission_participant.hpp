#pragma once

#include <functional>
#include <mutex>
#include <optional>
#include <stop_token>
#include <string>
#include <thread>
#include <utility>

#include "clock/ticks.hpp"
#include "skein/entity.hpp"
#include "skein/executor.hpp"
#include "time.idl.hpp"

namespace reconnaissance {

class SteppedTime;

/// In how many ticks one who takes part so many times a second has one; throws InvalidArgument
/// unless that is 1, 2, 5, 10, 25 or 50.
int period_of(std::int64_t rate_hz);

/// Takes part in the mission's time: does its work in each tick at which it is due, on a thread of
/// its own, and acknowledges the tick when the work is done. Whatever the work has published and
/// called by then has happened in that tick. If the entity's clock is a SteppedTime, the work is
/// done on the thread that makes that time instead. Thread-safe.
class Participant {
 public:
  using Work = std::function<void(Tick)>;

  /// Takes part `rate_hz` times a second of the mission, under the entity's name; throws as
  /// period_of() does. The work begins after start().
  Participant(skein::Entity& entity, int rate_hz, Work work);
  /// Leaves: time goes on without it.
  ~Participant();
  Participant(const Participant&) = delete;
  Participant& operator=(const Participant&) = delete;

  /// Joins. Call it when all that the work uses is there.
  void start();

  /// Why the work of the last tick ended by an exception; empty if it did not.
  std::string failure() const;

 private:
  void hear(const recon::MissionTime& time);
  void take_part(const std::stop_token& stop);
  void do_work(std::unique_lock<std::mutex>& lock);
  void acknowledge(std::unique_lock<std::mutex>& lock);

  skein::Entity& entity_;
  SteppedTime* const stepped_;  // nullptr: time is told on topics
  std::size_t number_ = 0;      // in the stepped time, once it has joined
  Work work_;
  recon::Acknowledgment told_;
  std::optional<skein::Publisher<recon::Acknowledgment>> acknowledgments_;

  skein::ManualExecutor hearing_;  // of the thread that takes part
  mutable std::mutex mutex_;
  std::optional<std::uint64_t> run_;
  Tick begun_ = -1;    // by the time's keeper
  Tick present_ = -1;  // that has begun here
  skein::Instant tell_again_{};
  std::string failure_;

  skein::Subscription<recon::MissionTime> time_;
  std::jthread thread_;
};

}  // namespace reconnaissance
