#pragma once

#include <limits>
#include <memory>
#include <optional>
#include <vector>

#include "recording/mcap/content.hpp"

namespace skein::recording {

struct ReaderOptions {
  /// So much of messages is in memory at a time; a chunk that has more is passed over.
  std::size_t memory = std::size_t{1} << 30;
};

/// Which messages.
struct Selection {
  std::vector<std::string> topics;  ///< Empty: all.
  std::uint64_t first = 0;          ///< By log time, as `last`, which belongs to it.
  std::uint64_t last = std::numeric_limits<std::uint64_t>::max();
};

struct FileIndex;
class MessageCursor;

/// The messages of a recording, ordered by log time; by their place in the file where that is
/// equal. (Where chunks overlap in time by more than the memory, only those in memory are in
/// order.) Must not outlive its Reader. Not thread-safe.
class Messages {
 public:
  explicit Messages(std::unique_ptr<MessageCursor> cursor);
  Messages(Messages&& other) noexcept;
  ~Messages();

  /// The next message; nothing at the end. Its data is valid until the next call.
  std::optional<Message> next();
  /// What had to be passed over so far, and why.
  const std::vector<std::string>& problems() const;

 private:
  std::unique_ptr<MessageCursor> cursor_;
};

/// Reads a recording in the MCAP format, whoever wrote it: by its index, or, where it was cut or
/// has none, all that is whole. Trusts nothing in the file. Thread-safe.
class Reader {
 public:
  /// Throws InvalidArgument if there is no such file, and if it is no MCAP.
  explicit Reader(std::string path, const ReaderOptions& options = {});
  ~Reader();

  /// False where its end is missing: whoever wrote it was killed, or writes still.
  bool is_complete() const;
  /// What is wrong with the file, in words.
  const std::vector<std::string>& problems() const;

  const std::map<std::uint16_t, Schema>& schemas() const;
  const std::map<std::uint16_t, Channel>& channels() const;
  /// By channel; those that can be read.
  const std::map<std::uint16_t, std::uint64_t>& message_counts() const;
  std::uint64_t message_count() const;
  /// Of the first and last message by log time; nothing without messages.
  std::optional<std::pair<std::uint64_t, std::uint64_t>> times() const;
  /// How many messages whoever wrote it had to drop, by topic.
  std::map<std::string, std::uint64_t> dropped() const;

  /// Of the wall clock while it was recorded.
  std::vector<ClockStep> clock_steps() const;

  const std::vector<Metadata>& metadata() const;
  std::vector<std::string> attachments() const;
  /// The first with this name. Throws InvalidArgument if it is not there, or damaged.
  Attachment attachment(const std::string& name) const;

  /// Throws InvalidArgument for a topic that is not there.
  Messages messages(const Selection& selection = {}) const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace skein::recording
