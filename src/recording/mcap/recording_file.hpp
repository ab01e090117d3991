#pragma once

#include <map>
#include <optional>
#include <set>
#include <string>

#include "recording/mcap/chunk.hpp"
#include "recording/mcap/compression.hpp"
#include "recording/mcap/output_file.hpp"
#include "recording/mcap/record_writer.hpp"

namespace skein::recording {

/// One MCAP file, from its beginning to its summary. Not thread-safe. All functions throw
/// WriteFailed if the file cannot be written; what was written before can then be read.
class RecordingFile {
 public:
  /// Without a level chunks are not compressed. Throws InvalidArgument, too.
  RecordingFile(std::string path, const std::string& library, std::optional<int> zstd_level);

  void write(const Schema& schema);
  /// After its schema.
  void write(const Channel& channel);
  void write(const Attachment& attachment);
  void write(const Metadata& metadata);
  /// After its channels.
  void write(const Chunk& chunk);
  /// The index, and the end. Nothing is written after it.
  void finish();

  bool has_schema(std::uint16_t id) const { return schema_ids_.contains(id); }
  bool has_channel(std::uint16_t id) const { return messages_.contains(id); }
  const std::string& path() const noexcept { return file_.path(); }
  std::uint64_t size() const noexcept { return file_.size(); }
  /// The earliest time of a message; nothing without one.
  std::optional<std::uint64_t> start() const;

 private:
  RecordWriter begin();
  void end() { file_.append(piece_); }
  void write_statistics();

  OutputFile file_;
  std::optional<Compressor> compressor_;
  Bytes piece_;  // what is written next

  // Records of the summary.
  Bytes schemas_;
  Bytes channels_;
  Bytes statistics_;
  Bytes chunk_indexes_;
  Bytes attachment_indexes_;
  Bytes metadata_indexes_;

  std::set<std::uint16_t> schema_ids_;
  std::map<std::uint16_t, std::uint64_t> messages_;  // by channel
  std::uint32_t attachment_count_ = 0;
  std::uint32_t metadata_count_ = 0;
  std::uint32_t chunk_count_ = 0;
  std::uint64_t start_ = 0;
  std::uint64_t end_ = 0;
};

}  // namespace skein::recording
