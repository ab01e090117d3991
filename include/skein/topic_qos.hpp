#pragma once

#include <chrono>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "skein/detail/version.hpp"

namespace skein {

/// What publishers and subscribers must agree on, and what they keep.
struct QosPolicies {
  /// A reliable reader matches only reliable writers.
  bool reliable = true;
  /// Late joiners get the writer's history. A transient-local reader matches only such writers.
  /// Whether a volatile reader gets the history of such a writer is unspecified.
  bool transient_local = false;
  /// Samples kept per instance, disposals included, by a writer, and by a reader until they are
  /// taken. Unset: all.
  std::optional<std::uint32_t> history_depth;
  /// Without history_depth: the number of unacknowledged samples at which a reliable writer blocks;
  /// 0: no limit on their number; it then blocks once 4 MiB of them wait. Readers have no limit: a
  /// full one would stop the reception of its participant, and with it the leases.
  std::uint32_t max_samples = 0;
  /// Reader: maximum number of samples that wait to be taken; a further one replaces the oldest. 0:
  /// no limit.
  std::uint32_t max_waiting = 0;
  /// How long a write waits for room before it throws Overloaded.
  std::chrono::milliseconds max_blocking{100};
  /// Automatic liveliness: a writer that is not heard of for this time is reported as not alive.
  /// Unset: never. Use the same value on both sides: a reader's must not be shorter than a
  /// writer's.
  std::optional<std::chrono::milliseconds> liveliness_lease;
  /// Longest time between two samples of an instance, from its first sample until it is disposed. A
  /// writer promises it, a reader expects it; each missed period is reported on that side. Unset:
  /// none. A reader's must not be shorter than a writer's.
  std::optional<std::chrono::milliseconds> deadline;
  /// Writer: readers get no sample that was written longer ago than this. Between hosts it is only
  /// as accurate as their clocks agree. Unset: samples never expire.
  std::optional<std::chrono::milliseconds> lifespan;
  /// Each instance is owned by the strongest living writer (of equals by the one with the lesser
  /// GUID), and readers get only its samples. Ownership passes on when that writer is unmatched,
  /// silent for its lease, or misses the reader's deadline. Both sides must agree.
  bool exclusive = false;
  /// Writer, only with `exclusive`: its strength, 0 or more.
  std::int32_t strength = 0;
};

/// What a topic's publishers offer and its subscribers request. Take the profile that fits the
/// data, the same on both sides, and change what must differ. A subscriber that requests more than
/// a publisher offers gets nothing from it; both log the reason.
///
/// By default every value reaches every matched subscriber that keeps up, in order. A publisher
/// that is 1024 values ahead of one waits, then throws Overloaded. A subscriber with 1024 waiting
/// values loses the oldest.
struct TopicQos : QosPolicies {
  /// The systems (vehicles and stations) in which the topic is published or read. Empty: the
  /// entity's own. A system's name is the DDS partition: peers without Skein use that partition, or
  /// are reached in the default partition if "" is named here.
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
