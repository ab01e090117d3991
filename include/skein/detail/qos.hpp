#pragma once

#include <chrono>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "skein/detail/operation.hpp"
#include "skein/guid.hpp"

namespace skein::dds {

/// An instance's identity: the key's big-endian CDR, zero-padded, if it never exceeds 16 bytes,
/// otherwise its MD5 (RTPS 9.6.4.8). All zero for keyless topics.
using KeyHash = Guid;

struct Topic {
  /// Letters, digits, `_` and `/`, 255 at most, as of all names; must not begin with a digit or
  /// `DCPS`.
  std::string name;
  std::string type_name;
  bool keyed = false;

  bool operator==(const Topic&) const = default;
};

/// What tells one version of a topic's type from another. `members`, by type and member, are those
/// of all types in it that may grow.
struct TypeVersion {
  std::uint64_t signature = 0;  ///< 0: not told, as by peers that are not built with Skein.
  std::vector<GrowingMember> members{};
  /// Its IDL, for people: a member a line, without indentation; empty where that is not known.
  std::string text{};
};

/// How samples are encoded. Any is said of foreign readers alone, which may take both.
enum class DataRepresentation { Xcdr1, Xcdr2, Any };

/// What writers and readers must agree on, and what they keep.
struct Qos {
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
  /// A writer and a reader match that have the same. The type decides it.
  DataRepresentation representation = DataRepresentation::Xcdr1;
  /// Where both sides tell it, and neither has only grown, they do not match.
  TypeVersion type{};
  /// Only endpoints that share a partition match. Exact names without wildcards (vendors differ);
  /// empty: the default partition, whose name is "". Fixed at creation.
  std::vector<std::string> partitions;
};

enum class InstanceState { Alive, Disposed };

}  // namespace skein::dds
