#include <algorithm>
#include <chrono>
#include <cstdio>
#include <nlohmann/json.hpp>
#include <optional>
#include <utility>

#include "brokerless_discovery/broker.hpp"
#include "command/commands.hpp"
#include "command/designer/recorded_states.hpp"
#include "command/designer/watch.hpp"
#include "command/look/topic_survey.hpp"
#include "command/print/interruption.hpp"
#include "command/print/json_output.hpp"
#include "command/print/local_time.hpp"
#include "core/printable.hpp"
#include "core/suggestion.hpp"
#include "core/system/whole_file.hpp"
#include "core/wall_clock.hpp"
#include "mission/process/exit_codes.hpp"
#include "recording/recorder.hpp"
#include "skein/detail/type_support.hpp"
#include "skein/entity.hpp"
#include "skein/error.hpp"

namespace skein::command {
namespace {

constexpr double kReportPeriod_s = 1;
constexpr std::size_t kLongestProblem = 1024;

std::string file_of(const RecordArguments& arguments) {
  if (!arguments.output.empty()) return arguments.output;
  return local_time(nanoseconds_since_1970(), "mission_%Y-%m-%d_%H-%M-%S.mcap");
}

recording::RecorderOptions options_of(const RecordArguments& arguments,
                                      const Interruption& interruption) {
  recording::RecorderOptions options;
  options.topics = arguments.topics;
  options.introspection = !arguments.only_topics;
  options.writer.split_size = arguments.split_megabytes * 1'000'000;
  options.gives_up = interruption.gives_up();
  return options;
}

void print_counts_text(const recording::WriterStatistics& statistics) {
  for (const auto& channel : statistics.channels) {
    if (channel.written + channel.dropped == 0) continue;
    std::printf("  %-48s %llu", printable(channel.topic).c_str(),
                static_cast<unsigned long long>(channel.written));
    if (channel.dropped > 0) {
      std::printf(", %llu dropped", static_cast<unsigned long long>(channel.dropped));
    }
    std::printf("\n");
  }
  for (const std::string& file : statistics.files) {
    std::printf("%s\n", printable(file, kLongestProblem).c_str());
  }
  std::printf("%llu messages, %llu bytes, %llu dropped\n",
              static_cast<unsigned long long>(statistics.written()),
              static_cast<unsigned long long>(statistics.bytes),
              static_cast<unsigned long long>(statistics.dropped()));
}

void print_counts_json(const recording::WriterStatistics& statistics) {
  auto channels = nlohmann::ordered_json::array();
  for (const auto& channel : statistics.channels) {
    if (channel.written + channel.dropped == 0) continue;
    channels.push_back(
        {{"topic", channel.topic}, {"messages", channel.written}, {"dropped", channel.dropped}});
  }
  print_json({{"files", statistics.files},
              {"messages", statistics.written()},
              {"bytes", statistics.bytes},
              {"dropped", statistics.dropped()},
              {"channels", channels}},
             true);
}

/// What is to be seen of the domain now, if anybody is there.
void note_state(designer::DomainWatch& watch, recording::Recorder& recorder) {
  const designer::DomainState state = watch.look();
  if (!state.entities.empty()) recorder.note(designer::kStates, idl::to_json(state));
}

bool has_mission(const recording::WriterStatistics& statistics) {
  return std::ranges::any_of(statistics.channels, [](const auto& channel) {
    return channel.topic != designer::kStates && channel.written > 0;
  });
}

/// Of the topics that were asked for, those that nobody had.
void tell_missing(const std::vector<std::string>& wanted,
                  const std::vector<recording::ChannelStatistics>& channels, Inspector& inspector) {
  std::vector<std::string> known;
  for (const std::string& topic : wanted) {
    if (std::ranges::count(channels, topic, &recording::ChannelStatistics::topic) > 0) continue;
    if (known.empty()) {
      for (const KnownTopic& each : known_topics(inspector, kAnswerPatience))
        known.push_back(each.name);
    }
    std::fprintf(stderr, "skein: topic '%s' has not appeared%s\n", printable(topic).c_str(),
                 suggestion(topic, known).c_str());
  }
}

}  // namespace

int record(const RecordArguments& arguments) {
  const Interruption interruption;
  Entity entity = join(arguments, "record");
  Inspector inspector(entity, interruption.gives_up());
  const std::string file = file_of(arguments);
  recording::Recorder recorder(entity, file, options_of(arguments, interruption));
  std::fprintf(stderr, "skein: recording into %s what domain %u has; Ctrl-C ends it\n",
               printable(file, kLongestProblem).c_str(), arguments.watched_domain());
  std::optional<designer::DomainWatch> watch;
  if (!arguments.only_topics)
    watch.emplace(entity, arguments.watched_domain(), std::nullopt, interruption.gives_up());
  bool alone = true;
  using std::chrono::steady_clock;
  const auto end = steady_clock::now() + std::chrono::duration_cast<Duration>(
                                             std::chrono::duration<double>(arguments.seconds));
  do {
    for (const std::string& topic : recorder.look(kAnswerPatience)) {
      std::fprintf(stderr, "skein: topic %s\n", printable(topic, kLongestProblem).c_str());
    }
    if (watch) note_state(*watch, recorder);
    if (!recorder.statistics().failure.empty()) break;
    if (std::exchange(alone, false) && entity.broker().all().empty())
      tell_missions_elsewhere(arguments);
  } while (!interruption.wait(kReportPeriod_s) &&
           (arguments.seconds <= 0 || steady_clock::now() < end));
  const auto print_counts = arguments.json ? print_counts_json : print_counts_text;
  try {
    recorder.close();
  } catch (const WriteFailed& error) {  // a full disk: what is in the file counts all the same
    print_counts(recorder.statistics());
    std::fprintf(stderr, "skein: %s\n", printable(error.what(), kLongestProblem).c_str());
    return launch::kOutputLost;
  }
  print_counts(recorder.statistics());
  tell_missing(arguments.topics, recorder.statistics().channels, inspector);
  if (has_mission(recorder.statistics())) return 0;
  std::fputs("skein: nothing was recorded\n", stderr);
  return launch::kNothingThere;
}

}  // namespace skein::command
