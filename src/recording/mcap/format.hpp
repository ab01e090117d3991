#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

/// What the files consist of: https://mcap.dev/spec.
namespace skein::recording {

inline constexpr std::array<std::byte, 8> kMagic{std::byte{0x89}, std::byte{'M'}, std::byte{'C'},
                                                 std::byte{'A'},  std::byte{'P'}, std::byte{'0'},
                                                 std::byte{'\r'}, std::byte{'\n'}};

enum class Opcode : std::uint8_t {
  Header = 0x01,
  Footer = 0x02,
  Schema = 0x03,
  Channel = 0x04,
  Message = 0x05,
  Chunk = 0x06,
  MessageIndex = 0x07,
  ChunkIndex = 0x08,
  Attachment = 0x09,
  AttachmentIndex = 0x0A,
  Statistics = 0x0B,
  Metadata = 0x0C,
  MetadataIndex = 0x0D,
  SummaryOffset = 0x0E,
  DataEnd = 0x0F,
};

/// Before each record: its opcode and its length.
inline constexpr std::size_t kRecordHeader = 1 + sizeof(std::uint64_t);
/// Of a message, before its data: channel, sequence number and two times.
inline constexpr std::size_t kMessageFields = 2 + 4 + 8 + 8;
inline constexpr std::size_t kFooterFields = 8 + 8 + 4;

/// The metadata record by which a recording says what it lacks: for each topic, how many of its
/// messages were dropped since the recording began. The last such record counts.
inline constexpr const char* kDropsName = "skein.dropped_messages";

/// The metadata record that says that the wall clock was set: `at_ns`, by log time, and `by_ns`.
inline constexpr const char* kClockStepName = "skein.clock_step";

}  // namespace skein::recording
