#include "time_keeper.hpp"

#include <fmt/format.h>

#include <chrono>

#include "in_system.hpp"
#include "skein/error.hpp"

namespace reconnaissance {
namespace {

using namespace std::chrono_literals;

// How often one looks whether somebody is gone.
constexpr auto kLook = 100ms;

std::uint64_t new_run() {
  return static_cast<std::uint64_t>(std::chrono::system_clock::now().time_since_epoch().count());
}

}  // namespace

std::string time_topic(int period) { return fmt::format("mission/time/every_{}", period); }

skein::TopicQos acknowledgment_qos() {
  skein::TopicQos qos;
  qos.history_depth = 1;  // a later one says all that an earlier one did
  qos.max_samples = 0;
  return qos;
}

skein::TopicQos time_qos() {
  skein::TopicQos qos = skein::TopicQos::state();
  qos.history_depth = 1024;  // ticks of another run are not to take the place of one of this run
  return qos;
}

TimeKeeper::TimeKeeper(skein::Entity& entity, std::size_t expected, double times_real_time,
                       const std::vector<std::string>& systems, skein::Duration patience)
    : entity_(entity),
      patience_(static_cast<int>(patience / kLook)),
      run_(new_run()),
      lock_step_(expected),
      pace_(times_real_time),
      acknowledgments_(entity.subscription<recon::Acknowledgment>(
          kAcknowledgments, in_systems(systems, acknowledgment_qos()),
          [this](const recon::Acknowledgment& acknowledgment) { hear(acknowledgment); },
          {.executor = &hearing_})) {
  // Who is late gets the last one, without which it could not acknowledge it.
  for (const int period : kPeriods) {
    time_.emplace(period, entity.publisher<recon::MissionTime>(
                              time_topic(period), in_systems(systems, skein::TopicQos::state())));
  }
}

std::optional<Tick> TimeKeeper::await_next(const std::stop_token& stop) {
  const std::stop_callback stops(stop, [this] { hearing_.post([] {}); });
  hearing_.run_until({}, [] { return true; });
  std::unique_lock lock(mutex_);
  while (!stop.stop_requested()) {
    const skein::Instant now = entity_.clock().now();
    const auto when = ready();
    if (when && *when <= now) return lock_step_.tick() + 1;
    const skein::Instant look = now + kLook;
    lock.unlock();
    hearing_.run_until(when ? std::min(*when, look) : look, [&] {
      std::lock_guard looks(mutex_);
      return ready() != when || stop.stop_requested();
    });
    lock.lock();
    if (!ready()) drop_the_lost(lock);
  }
  return std::nullopt;
}

void TimeKeeper::begin(Tick tick) {
  {
    std::lock_guard lock(mutex_);
    const skein::Instant now = entity_.clock().now();
    lock_step_.advance();
    pace_.begin(now);
    if (now - rate_since_ >= 1s) {
      ticks_per_second_ = static_cast<double>(tick - rate_from_) /
                          std::chrono::duration<double>(now - rate_since_).count();
      rate_since_ = now;
      rate_from_ = tick;
    }
  }
  const recon::MissionTime time{run_, tick, std::chrono::nanoseconds(time_of(tick)).count()};
  for (auto& [period, publisher] : time_) {
    if (!is_due(period, tick)) continue;
    try {
      publisher.publish(time);
    } catch (const skein::Error& error) {  // who should have had it is awaited from now on
      fmt::print(stderr, "time: tick {} could not be told: {}\n", tick, error.what());
    }
  }
}

std::optional<skein::Instant> TimeKeeper::ready() const {
  return lock_step_.may_advance() ? pace_.next() : std::nullopt;
}

void TimeKeeper::drop_the_lost(std::unique_lock<std::mutex>& lock) {
  lock.unlock();
  const std::size_t connected = acknowledgments_.publishers();
  lock.lock();
  for (const std::string& name : lock_step_.keep_connected(connected, patience_)) {
    fmt::print(stderr, "time: {} is lost; the mission's time goes on without it\n", name);
  }
}

void TimeKeeper::hear(const recon::Acknowledgment& acknowledgment) {
  std::lock_guard lock(mutex_);
  lock_step_.hear({.participant = acknowledgment.participant,
                   .life = acknowledgment.life,
                   .period = acknowledgment.period_ticks,
                   .done = acknowledgment.tick,
                   .leaves = acknowledgment.leaves});
}

Tick TimeKeeper::tick() const {
  std::lock_guard lock(mutex_);
  return lock_step_.tick();
}

std::size_t TimeKeeper::participants() const {
  std::lock_guard lock(mutex_);
  return lock_step_.participants();
}

std::vector<std::string> TimeKeeper::awaited() const {
  std::lock_guard lock(mutex_);
  return lock_step_.awaited();
}

Pace TimeKeeper::pace() const {
  std::lock_guard lock(mutex_);
  return pace_;
}

double TimeKeeper::ticks_per_second() const {
  std::lock_guard lock(mutex_);
  return ticks_per_second_;
}

void TimeKeeper::pause() {
  change([](Pace& pace) { pace.pause(); });
}
void TimeKeeper::resume() {
  change([](Pace& pace) { pace.resume(); });
}
void TimeKeeper::step(std::uint64_t ticks) {
  change([&](Pace& pace) { pace.step(ticks); });
}
void TimeKeeper::limit(double times_real_time) {
  change([&](Pace& pace) { pace.limit(times_real_time); });
}

void TimeKeeper::change(const std::function<void(Pace&)>& change) {
  {
    std::lock_guard lock(mutex_);
    change(pace_);
  }
  hearing_.post([] {});
}

}  // namespace reconnaissance
