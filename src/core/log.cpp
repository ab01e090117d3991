#include "core/log.hpp"

#include <array>
#include <atomic>
#include <cstdio>
#include <cstdlib>
#include <deque>
#include <mutex>

#include "core/printable.hpp"
#include "core/suggestion.hpp"
#include "core/utc_text.hpp"

namespace skein {
namespace {

constexpr std::size_t kLongestText = 4096;
constexpr std::array kLevels{LogLevel::Debug, LogLevel::Info, LogLevel::Warning, LogLevel::Error};

using Sink = std::function<void(const LogLine&)>;

std::uint64_t nanoseconds_of(std::chrono::system_clock::time_point time) {
  return static_cast<std::uint64_t>(std::chrono::nanoseconds(time.time_since_epoch()).count());
}

void write_to_standard_error(const std::string& before, const LogLine& line) {
  const std::string text = before + in_words(line.level) + ": " + printable(line.place) + ": " +
                           printable(line.text, kLongestText) + "\n";
  std::fputs(text.c_str(), stderr);
}

void write_with_time(const LogLine& line) {
  write_to_standard_error(utc_text(line.time) + " ", line);
}

struct Log {
  std::mutex mutex;
  Sink sink = write_with_time;
  std::deque<LoggedLine> kept;
  std::uint64_t last = 0;

  void add(const LogLine& line) {
    const std::lock_guard lock(mutex);
    if (kept.size() == kKeptLines) kept.pop_front();
    kept.push_back({++last, line.level, std::string(line.place),
                    std::string(line.text.substr(0, kLongestText)), nanoseconds_of(line.time)});
    sink(line);
  }
};

/// Never destroyed: static objects may log when they end.
Log& the_log() {
  static auto& log = *new Log;
  return log;
}

void refuse_level(const std::string& word) {
  const std::array<std::string, kLevels.size()> known{"debug", "info", "warning", "error"};
  the_log().add({LogLevel::Warning, "log",
                 "SKEIN_LOG is '" + word + "', which is no level" + suggestion(word, known) +
                     "; write debug, info, warning or error",
                 std::chrono::system_clock::now()});
}

LogLevel level_of_environment() {
  const char* const word = std::getenv("SKEIN_LOG");
  if (word == nullptr || *word == '\0') return LogLevel::Info;
  for (const LogLevel level : kLevels) {
    if (std::string_view(word) == in_words(level)) return level;
  }
  refuse_level(word);
  return LogLevel::Info;
}

std::atomic<LogLevel>& least_level() {
  static std::atomic<LogLevel> least{level_of_environment()};
  return least;
}

}  // namespace

const char* in_words(LogLevel level) noexcept {
  switch (level) {
    case LogLevel::Debug:
      return "debug";
    case LogLevel::Info:
      return "info";
    case LogLevel::Warning:
      return "warning";
    case LogLevel::Error:
      break;
  }
  return "error";
}

void write_without_time(const LogLine& line) { write_to_standard_error("", line); }

void set_log_level(LogLevel least) noexcept { least_level() = least; }

bool is_logged(LogLevel level) noexcept { return level >= least_level(); }

void set_log_sink(Sink sink) {
  const std::lock_guard lock(the_log().mutex);
  the_log().sink = sink ? std::move(sink) : Sink(write_with_time);
}

void log(LogLevel level, std::string_view place, std::string_view text) {
  if (is_logged(level)) the_log().add({level, place, text, std::chrono::system_clock::now()});
}

std::vector<LoggedLine> logged_after(std::uint64_t number) {
  const std::lock_guard lock(the_log().mutex);
  const std::uint64_t before = the_log().last - the_log().kept.size();
  const std::size_t skipped = number > before ? number - before : 0;
  if (skipped >= the_log().kept.size()) return {};
  return {the_log().kept.begin() + static_cast<std::ptrdiff_t>(skipped), the_log().kept.end()};
}

}  // namespace skein
