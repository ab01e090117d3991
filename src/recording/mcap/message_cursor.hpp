#pragma once

#include <vector>

#include "recording/mcap/chunk_reader.hpp"
#include "recording/mcap/reader.hpp"

namespace skein::recording {

/// Orders the messages of chunks, of which it reads each when its time comes. Not thread-safe.
class MessageCursor {
 public:
  /// `channels`: the ids of those that are wanted.
  MessageCursor(const InputFile& file, const FileIndex& index, std::set<std::uint16_t> channels,
                const Selection& selection, std::size_t memory);

  std::optional<Message> next();
  const std::vector<std::string>& problems() const noexcept { return problems_; }

 private:
  struct Entry {
    std::uint64_t log_time;
    std::uint64_t offset;  // of the message record
  };
  struct LoadedChunk {
    Bytes records;
    std::vector<Entry> entries;  // by time
    std::size_t next = 0;
    std::uint64_t offset = 0;  // its place in the file

    std::size_t size() const { return records.size() + entries.size() * sizeof(Entry); }
  };

  static bool comes_later(const LoadedChunk& a, const LoadedChunk& b);
  void load_until_due();
  void load(const ChunkPlace& place);
  void add_entry(LoadedChunk& chunk, const Record& record);

  const InputFile& file_;
  const std::set<std::uint16_t> channels_;
  const std::uint64_t first_;
  const std::uint64_t last_;
  const Allowance allowance_;
  std::uint64_t read_ = 0;                 // from chunks
  std::vector<const ChunkPlace*> places_;  // by time
  std::size_t next_place_ = 0;
  std::vector<LoadedChunk> heap_;  // the one with the next message in front
  std::size_t loaded_ = 0;         // bytes
  LoadedChunk finished_;           // holds the last message
  std::vector<std::string> problems_;
};

}  // namespace skein::recording
