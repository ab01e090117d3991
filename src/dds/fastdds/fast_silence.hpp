#pragma once

#include <chrono>
#include <memory>
#include <mutex>
#include <optional>
#include <vector>

#include "events.hpp"
#include "transport.hpp"

namespace skein::dds::fastdds {

/// Asks FastLeaseWatch which participants are silent, on the thread of `events`, and carries it
/// out: ends them, tells readers of writers that are not alive, and forgets all participants after
/// a sleep of this one.
class FastSilence {
 public:
  using Time = FastLeaseWatch::Time;

  /// `transport` outlives it, and hears nothing any more when it ends; `events` may end before.
  FastSilence(StartupTransportDescriptor::State& transport, EventThread& events);

  /// A participant has been found, or announces another lease; or it has gone.
  void follow(const Guid& participant, std::optional<std::chrono::nanoseconds> lease, Time now);
  void forget(const Guid& participant) { transport_.lease_watch.forget(participant); }

  /// Tells a reader of the liveliness of the writers that it is matched with, until it closes.
  void watch_liveliness(std::weak_ptr<EndpointEvents> reader, std::chrono::nanoseconds lease);

  /// Looks at all leases; to be called by each tick of `events`.
  void check(Time now);

 private:
  void check_each(std::chrono::nanoseconds lease);
  void check_leases(Time now);
  void check_liveliness(Time now);
  void forget_all();

  struct Watched {
    std::weak_ptr<EndpointEvents> reader;
    std::chrono::nanoseconds lease;
  };

  StartupTransportDescriptor::State& transport_;
  EventThread& events_;
  std::mutex mutex_;
  std::vector<Watched> watched_;
  /// How often leases are looked at; the shortest needed so far.
  std::chrono::nanoseconds period_{std::chrono::seconds(1)};
};

}  // namespace skein::dds::fastdds
