#pragma once

#include <cstddef>
#include <optional>
#include <string>

#include "interruption.hpp"

namespace skein::command {

/// Values on standard input, one a line of any length. Reads the descriptor itself: what stdio has
/// read ahead, poll() would not know of. Not thread-safe.
class ValueLines {
 public:
  /// `interruption` outlives it.
  explicit ValueLines(const Interruption& interruption)
      : interruption_(interruption), signals_(interruption.descriptor()) {}

  /// The next line that is not empty; nothing at the end, and when a signal comes. Throws
  /// Unavailable where standard input cannot be read.
  std::optional<std::string> next();

 private:
  std::string take_line(std::size_t size);
  bool wait_for_input() const;
  void read_more();

  const Interruption& interruption_;
  const FileDescriptor signals_;
  std::string unread_;
  bool ended_ = false;
};

}  // namespace skein::command
