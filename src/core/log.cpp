#include "core/log.hpp"

#include <cstdio>
#include <mutex>
#include <string>

#include "core/printable.hpp"

namespace skein {
namespace {

constexpr std::size_t kLongestText = 4096;

using Sink = std::function<void(LogLevel, std::string_view, std::string_view)>;

void write_to_standard_error(LogLevel level, std::string_view place, std::string_view text) {
  if (level < LogLevel::Warning) return;
  std::string line(level == LogLevel::Error ? "error: " : "warning: ");
  line.append(printable(place)).append(": ").append(printable(text, kLongestText)).append("\n");
  std::fputs(line.c_str(), stderr);
}

std::mutex& sink_mutex() {
  static std::mutex mutex;
  return mutex;
}

Sink& current_sink() {
  // Never destroyed: static objects may log when they end.
  static auto& sink = *new Sink(write_to_standard_error);
  return sink;
}

}  // namespace

void set_log_sink(Sink sink) {
  std::lock_guard lock(sink_mutex());
  current_sink() = sink ? std::move(sink) : Sink(write_to_standard_error);
}

void log(LogLevel level, std::string_view place, std::string_view text) {
  std::lock_guard lock(sink_mutex());
  current_sink()(level, place, text);
}

}  // namespace skein
