#include <array>
#include <cstdint>
#include <cstdio>
#include <map>
#include <string>
#include <utility>

#include "command/commands.hpp"
#include "command/print/interruption.hpp"
#include "command/print/json_output.hpp"
#include "command/print/local_time.hpp"
#include "command/print/wrapped.hpp"
#include "core/log.hpp"
#include "core/printable.hpp"
#include "rpc/service/introspection_topic.hpp"
#include "service_names.hpp"
#include "skein/entity.hpp"
#include "skein/introspection.idl.hpp"

namespace skein::command {
namespace {

constexpr std::size_t kLongestText = 4096;

introspection::Severity level_of(const std::string& word) {
  for (const auto level : {LogLevel::Debug, LogLevel::Info, LogLevel::Warning}) {
    if (word == in_words(level)) return static_cast<introspection::Severity>(level);
  }
  return introspection::Severity::Error;
}

/// Prints each line of a process once, though all entities of the process tell it.
class LogPrinter {
 public:
  explicit LogPrinter(const LogArguments& arguments)
      : arguments_(arguments), least_(level_of(arguments.level)) {}

  void show(const introspection::LogLine& line) {
    if (!arguments_.entity.empty() && !is_entity_named(line.entity, arguments_.entity)) return;
    auto& [latest, time] = shown_[{line.host, line.pid}];
    if (line.number <= latest && line.time <= time) return;  // a later one of less: a new process
    latest = line.number;
    time = line.time;
    if (line.level < least_) return;
    arguments_.json ? print_json(json_of(line), false) : print(line);
    std::fflush(stdout);
  }

 private:
  static void print(const introspection::LogLine& line) {
    std::array<char, 16> milliseconds{};
    std::snprintf(milliseconds.data(), milliseconds.size(), ".%03u ",
                  static_cast<unsigned>(line.time / 1'000'000 % 1000));
    const std::string text = local_time(line.time, "%H:%M:%S") + milliseconds.data() +
                             printable(line.entity) + " " +
                             in_words(static_cast<LogLevel>(line.level)) + ": " +
                             printable(line.place) + ": " + printable(line.text, kLongestText);
    std::printf("%s\n", folded(text, terminal_width()).c_str());
  }

  const LogArguments& arguments_;
  const introspection::Severity least_;
  std::map<std::pair<std::string, std::uint32_t>, std::pair<std::uint64_t, std::uint64_t>> shown_;
};

}  // namespace

int show_log(const LogArguments& arguments) {
  const Interruption interruption;
  Entity entity = join(arguments, "log");
  LogPrinter printer(arguments);
  introspection::Reader<introspection::LogLine> reader(
      entity.participant(), introspection::kLog,
      [&](const introspection::LogLine& line) { printer.show(line); });
  tell_waiting(arguments, "the next line of a log");
  interruption.wait(arguments.seconds);
  return 0;
}

}  // namespace skein::command
