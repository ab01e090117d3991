#pragma once

#include <chrono>
#include <cstddef>
#include <string>

#include "dds/port/port.hpp"

namespace skein::dds::cyclonedds {

/// When a writer asks for the acknowledgments that are missing: after `first`, and after twice as
/// long each time, up to `longest`.
struct HeartbeatIntervals {
  std::chrono::milliseconds first;
  std::chrono::milliseconds longest;
};

/// For a participant that has found so many others. A lost last sample is noticed after `first`. A
/// Fast DDS reader that found a writer anew counts its acknowledgments from 1, and Cyclone ignores
/// each one that is not above the last: the longer `longest`, the later it is heard. But each
/// heartbeat goes to all readers, and all answer: 50 participants that start at once, with the
/// intervals of a few, do little else. So a writer sends at most 160 heartbeats a second, to
/// however many readers.
HeartbeatIntervals heartbeat_intervals(std::size_t participants);

/// Cyclone's configuration of one participant's domain, as XML. Everything that must not come from
/// the environment is in it: a domain that is made with a configuration of its own reads no
/// CYCLONEDDS_URI.
std::string configuration(const ParticipantOptions& options);

}  // namespace skein::dds::cyclonedds
