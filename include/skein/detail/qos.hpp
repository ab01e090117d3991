#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "skein/detail/operation.hpp"
#include "skein/guid.hpp"
#include "skein/topic_qos.hpp"

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
struct Qos : QosPolicies {
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
