#pragma once

#include <string>
#include <vector>

#include "skein/detail/qos.hpp"

namespace skein {

/// What a topic's publishers offer and its subscribers request. Take the profile that fits the
/// data, the same on both sides, and change what must differ. A subscriber that requests more than
/// a publisher offers gets nothing from it; both log the reason.
///
/// By default every value reaches every matched subscriber that keeps up, in order. A publisher
/// that is 1024 values ahead of one waits, then throws Overloaded. A subscriber with 1024 waiting
/// values loses the oldest.
struct TopicQos : dds::Qos {
  /// The systems (vehicles and stations) in which the topic is published or read. Empty: the
  /// entity's own; without an entity, the default partition "". A system's name is the DDS
  /// partition: peers without Skein use that partition, or are reached in the default one if "" is
  /// named here.
  std::vector<std::string> systems{};

  TopicQos() {
    max_samples = 1024;
    max_waiting = 1024;
  }

  /// For measurements at a high rate, of which only new ones matter. Best effort; a slow subscriber
  /// finds the newest four of each key, and nothing older than the lifespan.
  static TopicQos sensor(std::chrono::milliseconds lifespan = std::chrono::milliseconds(500));

  /// For set-points: only the newest counts, and only the strongest publisher is heard. It must
  /// publish once per period. After two periods without a value both sides report a missed
  /// deadline, and command passes to the next publisher.
  static TopicQos command(std::int32_t strength = 0,
                          std::chrono::milliseconds period = std::chrono::milliseconds(100));

  /// For values that hold until they change: the last value of each key, also for late joiners.
  static TopicQos state();
};

}  // namespace skein
