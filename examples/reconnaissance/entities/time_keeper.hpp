#pragma once

#include <chrono>
#include <map>
#include <mutex>
#include <optional>
#include <stop_token>
#include <string>
#include <vector>

#include "clock/lock_step.hpp"
#include "clock/pace.hpp"
#include "skein/entity.hpp"
#include "time.idl.hpp"

namespace reconnaissance {

/// The topic on which those take part that are due every `period` ticks.
std::string time_topic(int period);
inline constexpr const char* kAcknowledgments = "mission/acknowledgment";
skein::TopicQos acknowledgment_qos();
/// Of who hears the time: late ones get the last tick.
skein::TopicQos time_qos();

/// Makes the mission's time: publishes a tick when all that were due at the one before have
/// acknowledged it. There is a topic for each rate, so that who takes part once a second is not
/// woken fifty times. One that is no longer connected, and has been silent for kPatience of real
/// time, is out, and time goes on without it. Thread-safe.
class TimeKeeper {
 public:
  /// A process that was stopped for a minute comes back, and to go on without it would be wrong;
  /// less than a ground station waits. One that is started anew is not waited for (see LockStep).
  static constexpr skein::Duration kPatience = std::chrono::seconds(90);

  /// Time begins when `expected` take part; `times_real_time` as for Pace. They are of the systems
  /// that are named, or else of the entity's own.
  TimeKeeper(skein::Entity& entity, std::size_t expected, double times_real_time,
             const std::vector<std::string>& systems = {}, skein::Duration patience = kPatience);

  /// Waits until the next tick may begin; its number, or nothing if the caller is told to stop.
  std::optional<Tick> await_next(const std::stop_token& stop);

  /// Begins it: tells those that are due. What belongs to the tick should be published before.
  void begin(Tick tick);

  std::uint64_t run() const { return run_; }
  Tick tick() const;
  std::size_t participants() const;
  std::vector<std::string> awaited() const;
  Pace pace() const;
  /// Over the last second or so.
  double ticks_per_second() const;

  void pause();
  void resume();
  void step(std::uint64_t ticks);
  void limit(double times_real_time);

 private:
  void hear(const recon::Acknowledgment& acknowledgment);
  /// Until when a tick that may begin is to wait; nothing while it may not.
  std::optional<skein::Instant> ready() const;
  void drop_the_lost(std::unique_lock<std::mutex>& lock);
  void change(const std::function<void(Pace&)>& change);

  skein::Entity& entity_;
  const int patience_;  // in looks
  std::uint64_t run_;
  std::map<int, skein::Publisher<recon::MissionTime>> time_;  // by period

  skein::ManualExecutor hearing_;  // of the thread that awaits ticks
  mutable std::mutex mutex_;
  LockStep lock_step_;
  Pace pace_;
  skein::Instant rate_since_{};
  Tick rate_from_ = 0;
  double ticks_per_second_ = 0;

  skein::Subscription<recon::Acknowledgment> acknowledgments_;
};

}  // namespace reconnaissance
