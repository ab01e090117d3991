#pragma once

#include <map>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "recording/mcap/content.hpp"
#include "recording/mcap/input_file.hpp"
#include "recording/mcap/record_reader.hpp"

namespace skein::recording {

/// Where messages lie: in a chunk, or one after the other in the file itself.
struct ChunkPlace {
  bool is_chunk = true;
  std::uint64_t start = 0;  ///< The earliest log time.
  std::uint64_t end = 0;
  std::uint64_t offset = 0;  ///< Of its record, or of the first message's.
  std::uint64_t length = 0;
  std::set<std::uint16_t> channels;  ///< Empty: unknown.
};

struct AttachmentPlace {
  std::string name;
  std::uint64_t offset = 0;
  std::uint64_t length = 0;
};

/// What a file contains, and where.
struct FileIndex {
  bool is_complete = false;
  std::map<std::uint16_t, Schema> schemas;
  std::map<std::uint16_t, Channel> channels;
  std::vector<ChunkPlace> chunks;
  std::map<std::uint16_t, std::uint64_t> message_counts;
  std::vector<Metadata> metadata;
  std::vector<AttachmentPlace> attachments;
  std::vector<std::string> problems;

  std::uint64_t kept =
      0;  ///< Bytes of schemas, channels and metadata, with those that are there twice.

  // These throw MalformedRecord.
  void add_schema(RecordReader fields);
  void add_channel(RecordReader fields);
  void add_metadata(RecordReader fields);
  void add_problem(std::string problem);
};

/// So much of schemas, channels and metadata is kept.
inline constexpr std::uint64_t kMostKept = std::uint64_t{64} << 20;

/// By the summary at the end of the file; nothing if it has none, or a wrong one. Throws
/// MalformedRecord if that becomes clear in its middle.
std::optional<FileIndex> read_summary(const InputFile& file, std::size_t memory);

/// By all records from the beginning, up to the last whole one.
FileIndex scan(const InputFile& file, std::size_t memory);

}  // namespace skein::recording
