#pragma once

#include <chrono>
#include <optional>

#include "recording/mcap/content.hpp"
#include "recording/mcap/writer.hpp"

namespace skein::recording {

/// Says which messages were dropped: in the log, and as a metadata record. At most once a second,
/// so that a disk that is slow gets no more to do. Not thread-safe.
class DropReport {
 public:
  /// What is to be written now; nothing if nothing was dropped since the last one. `last`: at
  /// the end of a file, when each drop is said.
  std::optional<Metadata> make(const std::vector<ChannelStatistics>& channels, bool last);
  /// The next file says all of them again.
  void begin_file() { told_ = 0; }

 private:
  std::uint64_t logged_ = 0;
  std::uint64_t told_ = 0;
  std::chrono::steady_clock::time_point when_{};
};

}  // namespace skein::recording
