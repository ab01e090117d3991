#pragma once

#include <termios.h>

#include <chrono>
#include <optional>
#include <string>
#include <vector>

#include "frame.hpp"

namespace skein::command::top {

/// A terminal as a whole screen, while this lives; what stood there is back afterwards. Where
/// stdout is no terminal, or one that cannot move its cursor, frames follow each other as text.
class Terminal {
 public:
  Terminal();
  ~Terminal();
  Terminal(const Terminal&) = delete;
  Terminal& operator=(const Terminal&) = delete;

  std::size_t width() const;
  /// Nothing where frames follow each other.
  std::optional<std::size_t> height() const;

  void show(const std::vector<Line>& lines) const;

  /// What was typed, once something was, or `time` has passed; empty where nothing was.
  std::string typed(std::chrono::milliseconds time) const;

 private:
  bool screen_ = false;
  bool colours_ = false;
  bool keys_ = false;
  termios before_{};
};

}  // namespace skein::command::top
