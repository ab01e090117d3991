#include <algorithm>
#include <array>
#include <cstdint>
#include <cstdio>
#include <map>
#include <mutex>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "command/commands.hpp"
#include "command/print/interruption.hpp"
#include "command/print/json_output.hpp"
#include "command/print/local_time.hpp"
#include "command/print/wrapped.hpp"
#include "core/log.hpp"
#include "core/printable.hpp"
#include "core/suggestion.hpp"
#include "entity/entity_access.hpp"
#include "rpc/service/introspection_topic.hpp"
#include "service_names.hpp"
#include "skein/entity.hpp"
#include "skein/introspection.idl.hpp"

namespace skein::command {
namespace {

constexpr std::size_t kLongestText = 4096;
constexpr std::size_t kMostOthers = 20;
// In which who is known has told what was logged before.
constexpr double kListens_s = 3;

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
    if (!is_asked_for(line.entity)) return;
    auto& [latest, time] = shown_[{line.host, line.pid}];
    if (line.number <= latest && line.time <= time) return;  // a later one of less: a new process
    latest = line.number;
    time = line.time;
    if (line.level < least_) return;
    arguments_.json ? print_json(json_of(line), false) : print(line);
    std::fflush(stdout);
  }

  /// If only others have told something, the name may be wrong.
  void tell_others() {
    std::lock_guard lock(mutex_);
    if (others_.empty() || heard_) return;
    const std::vector<std::string> known(others_.begin(), others_.end());
    const std::string nearest = suggestion(arguments_.entity, known);
    std::fprintf(stderr, "skein: no line of '%s' has come%s\n",
                 printable(arguments_.entity).c_str(),
                 nearest.empty() ? ("; there are some of " + joined(known)).c_str()
                                 : printable(nearest).c_str());
  }

 private:
  bool is_asked_for(const std::string& entity) {
    if (arguments_.entity.empty() || is_entity_named(entity, arguments_.entity)) {
      std::lock_guard lock(mutex_);
      return heard_ = true;
    }
    std::lock_guard lock(mutex_);
    if (others_.size() < kMostOthers) others_.insert(entity.substr(entity.find('/') + 1));
    return false;
  }

  static std::string joined(const std::vector<std::string>& names) {
    std::string all;
    for (const std::string& each : names) all += (all.empty() ? "" : ", ") + printable(each);
    return all;
  }

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
  std::mutex mutex_;  // of what follows
  bool heard_ = false;
  std::set<std::string> others_;
};

}  // namespace

int show_log(const LogArguments& arguments) {
  const Interruption interruption;
  Entity entity = join(arguments, "log");
  LogPrinter printer(arguments);
  introspection::Reader<introspection::LogLine> reader(
      EntityAccess::participant(entity), introspection::kTopic<introspection::LogLine>,
      [&](const introspection::LogLine& line) { printer.show(line); });
  tell_waiting(arguments, "the next line of a log");
  const bool for_ever = arguments.seconds == 0;
  const double listens = for_ever ? kListens_s : std::min(kListens_s, arguments.seconds);
  if (interruption.wait(listens)) return 0;
  printer.tell_others();
  if (for_ever || arguments.seconds > listens)
    interruption.wait(for_ever ? 0 : arguments.seconds - listens);
  return 0;
}

}  // namespace skein::command
