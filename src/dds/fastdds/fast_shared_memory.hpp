#pragma once

#include <cstddef>
#include <optional>
#include <string>

#include "core/system/file_descriptor.hpp"

/// Fast DDS maps files in /dev/shm and fills them when a participant is made, without asking for
/// room: where there is none, the kernel ends the process by SIGBUS.
namespace skein::dds::fastdds {

/// What a participant's segments take: samples on their way, and its port.
inline constexpr std::size_t kSegment = 16u << 20;
inline constexpr std::size_t kSegmentsInAll = kSegment + (1u << 20);

/// So that no other participant of this user takes the room that one has found for its segments.
/// Waits for its turn.
class SegmentsTurn {
 public:
  explicit SegmentsTurn(bool needed);

 private:
  FileDescriptor file_;
};

/// Why there is no room for another participant's segments; nothing where there is.
std::optional<std::string> lacks_room_for_segments();

}  // namespace skein::dds::fastdds
