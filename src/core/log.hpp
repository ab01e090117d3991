#pragma once

#include <functional>
#include <string_view>

namespace skein {

enum class LogLevel { Debug, Info, Warning, Error };

/// Where the library's messages go. The default writes warnings and errors to standard error, one
/// line each. Thread-safe; `sink` is called from any thread, vendors' included, and must not block.
void set_log_sink(
    std::function<void(LogLevel, std::string_view place, std::string_view text)> sink);

/// Writes one message; `place` names the part of the library (`dds/cyclonedds`, `broker`).
void log(LogLevel level, std::string_view place, std::string_view text);

}  // namespace skein
