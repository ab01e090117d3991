#pragma once

#include <condition_variable>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <stop_token>
#include <string>
#include <thread>
#include <utility>

#include "clock/mission_clock.hpp"
#include "clock/participation.hpp"
#include "skein/entity.hpp"
#include "time.idl.hpp"

namespace reconnaissance {

/// Takes part in the mission's time: does its work in each tick at which it is due, on a thread of
/// its own, and acknowledges the tick when the work is done. Whatever the work has published and
/// called by then has happened in that tick. Thread-safe.
class Participant {
 public:
  using Work = std::function<void(Tick)>;

  /// Takes part `rate_hz` times a second of the mission, under the entity's name; throws
  /// InvalidArgument unless that is 1, 2, 5, 10, 25 or 50. The work begins after start().
  Participant(skein::Entity& entity, int rate_hz, Work work);
  /// Leaves: time goes on without it.
  ~Participant();
  Participant(const Participant&) = delete;
  Participant& operator=(const Participant&) = delete;

  /// Joins. Call it when all that the work uses is there.
  void start();

  /// The mission's clock. Its timers run when their tick begins here, before the work.
  MissionClock& clock() { return clock_; }

  /// The present tick, the last that has begun here; -1 before the first.
  Tick tick() const;

  /// Why the work of the last tick ended by an exception; empty if it did not.
  std::string failure() const;

  /// While it lives, the mission's time may advance by as much as it has lived, or by the latency
  /// that was given, and no more (see Participation): for work that takes time in the mission, too.
  class Hold {
   public:
    explicit Hold(Participant& participant, std::optional<skein::Duration> latency);
    ~Hold();
    Hold(const Hold&) = delete;
    Hold& operator=(const Hold&) = delete;

   private:
    Participant& participant_;
    Participation::Hold hold_;
  };
  Hold hold(std::optional<skein::Duration> latency = std::nullopt) { return Hold(*this, latency); }

 private:
  void hear(const recon::MissionTime& time);
  void take_part(const std::stop_token& stop);
  void do_work(std::unique_lock<std::mutex>& lock);
  void acknowledge(std::unique_lock<std::mutex>& lock);

  skein::Entity& entity_;
  Work work_;
  recon::Acknowledgment told_;
  std::optional<skein::Publisher<recon::Acknowledgment>> acknowledgments_;
  MissionClock clock_;

  mutable std::mutex mutex_;
  std::condition_variable_any changed_;
  std::optional<std::uint64_t> run_;
  Tick begun_ = -1;    // by the time's keeper
  Tick present_ = -1;  // here
  Participation participation_;
  std::uint64_t releases_ = 0;  // so that the thread looks again
  skein::Instant tell_again_{};
  std::string failure_;

  skein::Subscription<recon::MissionTime> time_;
  std::jthread thread_;
};

}  // namespace reconnaissance
