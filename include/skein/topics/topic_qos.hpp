#pragma once

#include <string>
#include <vector>

#include "skein/dds/port.hpp"

namespace skein {

/// What a topic's publishers promise and its subscribers ask for. Take the profile that fits the
/// stream, the same on both sides, and change what must differ. A subscriber that asks for more
/// than a publisher promises does not hear it; both then log why.
///
/// By default every value reaches every subscriber that is there, in order; a publisher that is
/// 1024 values ahead of one waits, and in the end throws Overloaded.
struct TopicQos : dds::Qos {
  /// The vehicles and stations whose topic of that name it is; empty: the entity's own. The
  /// system's name is the DDS partition, so peers without Skein are reached by naming it there, or
  /// in "".
  std::vector<std::string> systems{};

  TopicQos() {
    max_samples = 1024;
    max_waiting = 1024;
  }

  /// Measurements, at a high rate: only new ones are worth anything. Best effort; a subscriber that
  /// is late finds the newest four; nothing older than the lifespan.
  static TopicQos sensor(std::chrono::milliseconds lifespan = std::chrono::milliseconds(500));

  /// Set-points from whoever has command: the newest counts, and the strongest publisher is heard
  /// alone. It must publish once a period; after two without a word its command is missed, told on
  /// both sides, and passes to the next.
  static TopicQos command(std::int32_t strength = 0,
                          std::chrono::milliseconds period = std::chrono::milliseconds(100));

  /// What is the case until it changes: the last value of each key, also for those who come late.
  static TopicQos state();
};

}  // namespace skein
