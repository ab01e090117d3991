#include "compatibility.hpp"

#include <algorithm>

namespace skein::dds {
namespace {

using Period = std::optional<std::chrono::milliseconds>;

std::string text(const Period& period) {
  return period ? std::to_string(period->count()) + " ms" : "none";
}

/// A reader that wants something at least so often is content with more often only.
bool often_enough(const Period& offered, const Period& requested) {
  return !requested || (offered && *offered <= *requested);
}

struct Mismatch {
  const char* policy;
  std::string offered;
  std::string requested;
  const char* remedy;
};

std::optional<Mismatch> find_mismatch(const Qos& offered, const Qos& requested) {
  if (requested.reliable && !offered.reliable) {
    return Mismatch{"reliability", "best effort", "reliable",
                    "make the writer reliable or the reader best effort"};
  }
  if (requested.transient_local && !offered.transient_local) {
    return Mismatch{"durability", "volatile", "transient-local",
                    "make the writer transient-local or the reader volatile"};
  }
  if (!often_enough(offered.deadline, requested.deadline)) {
    return Mismatch{"deadline", text(offered.deadline), text(requested.deadline),
                    "give the writer a deadline that is no longer than the reader's"};
  }
  if (!often_enough(offered.liveliness_lease, requested.liveliness_lease)) {
    return Mismatch{"liveliness", text(offered.liveliness_lease), text(requested.liveliness_lease),
                    "give the writer a lease that is no longer than the reader's"};
  }
  if (requested.exclusive != offered.exclusive) {
    return Mismatch{"ownership", offered.exclusive ? "exclusive" : "shared",
                    requested.exclusive ? "exclusive" : "shared", "give both sides the same"};
  }
  return std::nullopt;
}

}  // namespace

bool share_partition(const Qos& writer, const Qos& reader) {
  const std::vector<std::string> standard{""};
  const auto& offered = writer.partitions.empty() ? standard : writer.partitions;
  const auto& wanted = reader.partitions.empty() ? standard : reader.partitions;
  return std::ranges::any_of(offered, [&](const std::string& partition) {
    return std::ranges::find(wanted, partition) != wanted.end();
  });
}

std::optional<Incompatibility> find_incompatibility(const std::string& topic, const Guid& peer,
                                                    const Qos& offered, const Qos& requested) {
  const auto found = find_mismatch(offered, requested);
  if (!found) return std::nullopt;
  return Incompatibility{peer, found->policy, found->offered, found->requested,
                         "topic '" + topic + "': a writer and a reader do not match in " +
                             found->policy + ": the writer offers " + found->offered +
                             ", the reader requests " + found->requested + "; " + found->remedy +
                             " (the other side is " + peer.hex() + ")"};
}

}  // namespace skein::dds
