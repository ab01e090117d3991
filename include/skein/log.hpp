#pragma once

#include <chrono>
#include <functional>
#include <string_view>

#include "skein/detail/version.hpp"

namespace skein {

enum class LogLevel { Debug, Info, Warning, Error };

/// One line of the log. The texts are valid during the call of the sink only.
struct LogLine {
  LogLevel level;
  std::string_view place;  ///< Part of the program: `broker`, `dds/cyclonedds`, an entity's id.
  std::string_view text;
  std::chrono::system_clock::time_point time;
};

/// Logs a line of the library or of the application:
///
///     skein::log(skein::LogLevel::Info, "navigator", "the map has 12 obstacles");
///
/// The line goes to the sink. The process also keeps the latest 256 lines: `skein log` shows them
/// and those that follow, for all entities of a domain. Thread-safe.
void log(LogLevel level, std::string_view place, std::string_view text);

/// From now on, log() drops lines below `least`. The default is Info, or what the environment
/// variable SKEIN_LOG names: debug, info, warning or error.
void set_log_level(LogLevel least) noexcept;

/// Whether log() takes lines of this level. Spares the making of texts that nobody reads.
bool is_logged(LogLevel level) noexcept;

/// Replaces what receives the lines: a logger of the application, such as spdlog or the journal.
/// The default writes to standard error, one line each: time, level, place and text. An empty
/// function restores it. Any thread may call the sink, vendors' threads included, but one at a
/// time. It must not block, log or throw.
void set_log_sink(std::function<void(const LogLine& line)> sink);

}  // namespace skein
