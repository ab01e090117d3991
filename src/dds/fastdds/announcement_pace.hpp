#pragma once

#include <chrono>
#include <cstdint>
#include <map>
#include <mutex>
#include <optional>
#include <tuple>
#include <unordered_map>

#include "dds/rtps/rtps_message.hpp"

namespace skein::dds::fastdds {

/// The number of a participant's announcement that this participant sends; nothing of other
/// submessages, and of farewells.
std::optional<std::int64_t> announcement_number(const rtps_message::Submessage& submessage);

/// Decides which announcements are sent where.
///
/// Whenever Fast DDS discovers a participant it announces itself, not to that one but to all it
/// knows, and to all ports where somebody might listen: each of 50 peers that start at once sends
/// some 5000 announcements, and on two processors reading them takes longer than all else. One is
/// needed by who was just discovered, and one a period by each. Thread-safe.
class AnnouncementPace {
 public:
  using Time = std::chrono::steady_clock::time_point;

  /// Where a message goes: by which socket, to which address and port.
  using Destination = std::tuple<const void*, std::uint32_t, std::uint32_t>;

  /// Fast DDS announces itself once a `period` by itself.
  explicit AnnouncementPace(std::chrono::nanoseconds period) : period_(period) {}

  /// A participant that listens on this port, on any host, was discovered: the next announcement
  /// that goes there is sent.
  void discovered(std::uint32_t port, Time now);

  /// Whether the announcement of that number is to be sent there now; notes that it is.
  bool due(std::int64_t number, const Destination& destination, Time now);

 private:
  struct Sent {
    unsigned times = 0;
    Time last;
  };

  const std::chrono::nanoseconds period_;
  std::mutex mutex_;
  std::int64_t number_ = 0;
  std::map<Destination, Sent> sent_;
  std::unordered_map<std::uint32_t, Time> discovered_;  // by port
};

}  // namespace skein::dds::fastdds
