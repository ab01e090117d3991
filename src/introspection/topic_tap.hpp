#pragma once

#include <functional>
#include <memory>

#include "dds/port/port.hpp"
#include "skein/inspector.hpp"

namespace skein {

/// All run on a vendor's thread: they must return soon.
struct TopicTap {
  std::function<void(const dds::Sample& value)> on_value;
  std::function<void(const Guid& writer, bool matched)> on_matched{};
  std::function<void(const dds::Sample& end)> on_disposed{};  ///< Of the instance of its key; of
                                                              ///< keyed topics alone.
};

/// Reads the values of a topic as they travel, in these of its systems, with its reading_qos().
/// Throws as Participant::create_reader().
std::unique_ptr<dds::Reader> tap_topic(dds::Participant& participant, const KnownTopic& topic,
                                       std::vector<std::string> systems, TopicTap tap);

}  // namespace skein
