#pragma once

#include <chrono>
#include <memory>
#include <optional>
#include <string_view>
#include <vector>

#include "recording/mcap/content.hpp"

namespace skein::recording {

struct WriterOptions {
  /// zstd's: 1 to 22, or negative; without one nothing is compressed.
  std::optional<int> compression_level = 1;
  /// Messages are compressed and written together until they have this size, or this age. After a
  /// crash those of the last chunk are missing.
  std::size_t chunk_size = std::size_t{1} << 20;
  std::chrono::milliseconds chunk_age{500};
  /// Messages that wait for the disk, in bytes.
  std::size_t queue_size = std::size_t{64} << 20;
  /// With a full queue, write() waits for room instead of dropping the message.
  bool wait_for_room = false;
  /// A file ends before it has more than this size, or messages of a longer time; the next one goes
  /// on. 0: one file.
  std::uint64_t split_size = 0;
  std::chrono::nanoseconds split_duration{0};
  std::string library = "skein";  ///< Who writes, for those who look into the file.
};

struct ChannelStatistics {
  std::string topic;
  std::uint64_t written = 0;  ///< Messages that are in the file.
  std::uint64_t dropped = 0;  ///< Messages that will never be there.
};

struct WriterStatistics {
  std::vector<ChannelStatistics> channels;
  std::uint64_t bytes = 0;         ///< Of all files.
  std::vector<std::string> files;  ///< Their paths.
  std::string failure;             ///< Why nothing is written any more; empty while all is well.

  std::uint64_t written() const;
  std::uint64_t dropped() const;
};

/// Writes a recording in the MCAP format. Messages are copied into a bounded queue; a thread of the
/// writer compresses them and hands them to the kernel, so that they outlive this process. Nothing
/// is dropped silently: every message that is not taken is counted, said in the log, and in the
/// file. Where the disk is full, that is logged at once, nothing more is written, and what stands
/// in the file can be read. Thread-safe, but for the destructor.
class Writer {
 public:
  /// `path` is the file; with splitting `name.mcap` stands for `name_0.mcap`, `name_1.mcap`, …,
  /// each of which is complete. Throws InvalidArgument for options that make no sense, and
  /// WriteFailed if the file is there already or cannot be made.
  Writer(const std::string& path, const WriterOptions& options);
  explicit Writer(const std::string& path) : Writer(path, WriterOptions()) {}
  /// Closes it; what close() would throw is logged.
  ~Writer();

  /// Give the id for what follows. Throw InvalidArgument if there are 65535 already.
  std::uint16_t add_schema(std::string name, std::string encoding, std::string data);
  /// `schema` may be 0: none. Throws InvalidArgument if it is unknown.
  std::uint16_t add_channel(std::string topic, std::uint16_t schema,
                            std::map<std::string, std::string> metadata = {},
                            std::string message_encoding = "cdr");

  /// False if the message was dropped: the queue is full, the disk is, or it is closed. Does not
  /// wait, unless `wait_for_room` says so. Throws InvalidArgument for a channel that is unknown.
  bool write(const Message& message);

  /// Counts messages that were lost before they could be written. Throws as write().
  void count_dropped(std::uint16_t channel, std::uint64_t messages);

  /// Are in each file of the recording.
  void attach(Attachment attachment);
  void add_metadata(Metadata metadata);

  WriterStatistics statistics() const;

  /// Writes what waits, and the index. Throws WriteFailed if something could not be written.
  void close();

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace skein::recording
