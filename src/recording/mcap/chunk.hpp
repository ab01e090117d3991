#pragma once

#include <chrono>
#include <cstdint>
#include <vector>

#include "recording/mcap/content.hpp"
#include "skein/detail/bytes.hpp"

namespace skein::recording {

/// Messages that are compressed and written together, as records, with an index of each channel.
class Chunk {
 public:
  struct IndexEntry {
    std::uint64_t log_time;
    std::uint64_t offset;
  };

  void add(const Message& message);
  /// Empty, and as large as before.
  void clear();

  bool empty() const noexcept { return channels_.empty(); }
  std::uint64_t start() const noexcept { return start_; }
  std::uint64_t end() const noexcept { return end_; }
  const Bytes& records() const noexcept { return records_; }
  /// Those that have messages in it.
  const std::vector<std::uint16_t>& channels() const noexcept { return channels_; }
  const std::vector<IndexEntry>& index(std::uint16_t channel) const { return index_[channel]; }

  /// When its first message came.
  std::chrono::steady_clock::time_point began;

 private:
  Bytes records_;
  std::vector<std::uint16_t> channels_;
  std::vector<std::vector<IndexEntry>> index_;  // by channel
  std::uint64_t start_ = 0;
  std::uint64_t end_ = 0;
};

/// What a message takes in a chunk.
std::size_t record_size(const Message& message);

}  // namespace skein::recording
