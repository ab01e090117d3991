#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "recording/mcap/reader.hpp"

namespace skein::recording {

/// A value of a recording, by the types that the recording holds.
struct RecordedValue {
  const Channel& channel;
  std::uint64_t log_time;   ///< In nanoseconds since 1970.
  const std::string& json;  ///< As idl::to_json() has it.
};

/// What could not be shown.
struct UnreadValues {
  std::uint64_t count = 0;
  std::string first;  ///< The topic of the first one, and why it could not.
};

/// `3 values could not be read; the first is pose: …`; empty if there are none.
std::string to_text(const UnreadValues& unread);

/// Calls `visit` for each value on `topics` (empty: on all channels whose types the recording
/// holds), in the order of the recording, until it returns false. A value that is none of its type
/// is counted, and left out. Throws InvalidArgument for a topic that is not there, with the most
/// similar name, or whose types the recording does not hold, and if it holds no types at all.
UnreadValues for_each_value(const Reader& recording, const std::vector<std::string>& topics,
                            const std::function<bool(const RecordedValue&)>& visit);

/// Whether entities published that on a topic: it is no call, decision or the like.
bool is_of_topic(const Channel& channel);

}  // namespace skein::recording
