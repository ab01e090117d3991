#include "fast_silence.hpp"

#include <algorithm>

namespace skein::dds::fastdds {

FastSilence::FastSilence(StartupTransportDescriptor::State& transport, EventThread& events)
    : transport_(transport), events_(events) {
  transport_.suspend.on_wake = [this] { events_.post([this] { forget_all(); }); };
}

void FastSilence::follow(const Guid& participant, std::optional<std::chrono::nanoseconds> lease,
                         Time now) {
  transport_.lease_watch.follow(participant, lease, now);
  if (lease) check_each(*lease);
}

void FastSilence::watch_liveliness(std::weak_ptr<EndpointEvents> reader,
                                   std::chrono::nanoseconds lease) {
  {
    std::lock_guard lock(mutex_);
    watched_.push_back({std::move(reader), lease});
  }
  check_each(lease);
}

/// Often enough to see in time that `lease` ran out.
void FastSilence::check_each(std::chrono::nanoseconds lease) {
  constexpr int kChecksInALease = 20;
  const auto period = std::max(lease / kChecksInALease, EventThread::kShortestTick);
  {
    std::lock_guard lock(mutex_);
    period_ = std::min(period_, period);
  }
  events_.tick_every(period);
}

/// Both by one reading of the clock: a stop of this process between two would be told as silence.
void FastSilence::check(Time now) {
  if (transport_.discovery.removal().is_wanted()) return;  // nobody is heard: a pause, no silence
  check_leases(now);
  check_liveliness(now);
}

void FastSilence::check_leases(Time now) {
  std::chrono::nanoseconds period;
  {
    std::lock_guard lock(mutex_);
    period = period_;
  }
  for (const Guid& gone : transport_.lease_watch.watch(now, period)) {
    transport_.discovery.say_farewell(gone);
  }
}

void FastSilence::check_liveliness(Time now) {
  std::vector<Watched> watched;
  {
    std::lock_guard lock(mutex_);
    std::erase_if(watched_, [](const Watched& each) { return each.reader.expired(); });
    watched = watched_;
  }
  for (const Watched& each : watched) {
    const auto reader = each.reader.lock();
    if (!reader) continue;
    for (const Guid& writer : reader->peers()) {
      reader->alive(writer, transport_.lease_watch.alive(writer.participant(), each.lease, now));
    }
  }
}

void FastSilence::forget_all() {
  for (const Guid& each : transport_.lease_watch.drop_all())
    transport_.discovery.say_farewell(each);
  transport_.suspend.awake(std::chrono::steady_clock::now());
}

}  // namespace skein::dds::fastdds
