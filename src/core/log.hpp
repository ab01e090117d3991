#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "skein/log.hpp"

namespace skein {

/// A line that this process has logged. Numbers begin at 1 and have no gaps.
struct LoggedLine {
  std::uint64_t number;
  LogLevel level;
  std::string place;
  std::string text;
  std::uint64_t time;  ///< In nanoseconds since 1970.
};

/// What this process has logged after the line `number`, of the latest kKeptLines.
std::vector<LoggedLine> logged_after(std::uint64_t number);

inline constexpr std::size_t kKeptLines = 256;

/// `warning`: as SKEIN_LOG and `skein log --level` have it.
const char* in_words(LogLevel level) noexcept;

/// The default sink, without the time: for a process whose launcher writes that before each line.
void write_without_time(const LogLine& line);

}  // namespace skein
