#pragma once

#include <mutex>
#include <string>
#include <string_view>

#include "skein/log.hpp"

namespace skein::test {

/// What is logged while it lives.
class Log {
 public:
  Log() {
    set_log_sink([this](const LogLine& line) {
      std::lock_guard lock(mutex_);
      text_.append(line.place).append(": ").append(line.text).append("\n");
    });
  }
  ~Log() { set_log_sink({}); }

  /// Line by line, `place: text`.
  std::string text() const {
    std::lock_guard lock(mutex_);
    return text_;
  }

  /// How often that was said.
  int count(std::string_view part) const {
    std::lock_guard lock(mutex_);
    int times = 0;
    for (auto at = text_.find(part); at != std::string::npos; at = text_.find(part, at + 1)) {
      ++times;
    }
    return times;
  }

 private:
  mutable std::mutex mutex_;
  std::string text_;
};

}  // namespace skein::test
