#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <span>
#include <string>

/// What a recording contains. Texts are UTF-8. Times are nanoseconds since 1970, by the wall clock
/// at the recording's start and a clock that nobody sets.
namespace skein::recording {

/// How the messages of channels are to be decoded.
struct Schema {
  std::uint16_t id = 0;  ///< Not 0.
  std::string name;      ///< Of the type: `A::S`.
  std::string encoding;  ///< `omgidl`.
  std::string data;

  bool operator==(const Schema&) const = default;
};

/// The messages of one type on one topic.
struct Channel {
  std::uint16_t id = 0;
  std::uint16_t schema = 0;  ///< 0: none.
  std::string topic;
  std::string message_encoding;  ///< `cdr`.
  std::map<std::string, std::string> metadata;

  bool operator==(const Channel&) const = default;
};

struct Message {
  std::uint16_t channel = 0;
  std::uint32_t sequence = 0;
  std::uint64_t log_time = 0;      ///< When it was recorded.
  std::uint64_t publish_time = 0;  ///< When it was written.
  /// With message encoding `cdr` as it travelled: encapsulation header and value.
  std::span<const std::byte> data;
};

/// A file inside the recording.
struct Attachment {
  std::string name;
  std::string media_type;  ///< `text/plain`.
  std::string data;
  std::uint64_t log_time = 0;
  std::uint64_t create_time = 0;

  bool operator==(const Attachment&) const = default;
};

/// The wall clock was set while it was recorded.
struct ClockStep {
  std::uint64_t at = 0;  ///< By log time, which goes on as if it had not been set.
  std::int64_t by = 0;   ///< In nanoseconds; negative: back.

  bool operator==(const ClockStep&) const = default;
};

struct Metadata {
  std::string name;
  std::map<std::string, std::string> values;

  bool operator==(const Metadata&) const = default;
};

}  // namespace skein::recording
