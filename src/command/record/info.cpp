#include <cstdio>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "command/commands.hpp"
#include "command/print/json_output.hpp"
#include "command/print/local_time.hpp"
#include "core/printable.hpp"
#include "recording/mcap/reader.hpp"

namespace skein::command {
namespace {

constexpr double kNanoseconds = 1e9;
constexpr std::size_t kLongestPath = 4096;

nlohmann::ordered_json json_of_recording(const recording::Reader& reader) {
  nlohmann::ordered_json json{{"complete", reader.is_complete()},
                              {"messages", reader.message_count()},
                              {"problems", reader.problems()},
                              {"attachments", reader.attachments()},
                              {"channels", nlohmann::ordered_json::array()}};
  if (const auto times = reader.times()) {
    json["first_ns"] = times->first;
    json["last_ns"] = times->second;
  }
  for (const recording::ClockStep& step : reader.clock_steps())
    json["clock_steps"].push_back({{"at_ns", step.at}, {"by_ns", step.by}});
  const auto& counts = reader.message_counts();
  const auto dropped = reader.dropped();
  for (const auto& [id, channel] : reader.channels()) {
    const auto schema = reader.schemas().find(channel.schema);
    const auto count = counts.find(id);
    const auto lost = dropped.find(channel.topic);
    json["channels"].push_back(
        {{"topic", channel.topic},
         {"schema", schema == reader.schemas().end() ? "" : schema->second.name},
         {"messages", count == counts.end() ? 0 : count->second},
         {"dropped", lost == dropped.end() ? 0 : lost->second},
         {"metadata", channel.metadata}});
  }
  return json;
}

void print_recording(const recording::Reader& reader) {
  const auto json = json_of_recording(reader);
  for (const auto& channel : json["channels"]) {
    std::printf("%-48s %-40s %llu messages", printable(channel["topic"].get<std::string>()).c_str(),
                printable(channel["schema"].get<std::string>()).c_str(),
                channel["messages"].get<unsigned long long>());
    const auto dropped = channel["dropped"].get<unsigned long long>();
    if (dropped > 0) std::printf(", %llu dropped", dropped);
    std::printf("\n");
  }
  if (const auto times = reader.times()) {
    std::printf("from %s, %.3f s\n", local_time(times->first, "%Y-%m-%d %H:%M:%S").c_str(),
                static_cast<double>(times->second - times->first) / kNanoseconds);
  }
  for (const recording::ClockStep& step : reader.clock_steps()) {
    std::printf("at %s the wall clock was set by %.3f s; times go on from the recording's start\n",
                local_time(step.at, "%H:%M:%S").c_str(),
                static_cast<double>(step.by) / kNanoseconds);
  }
  std::printf(
      "%llu messages%s\n", static_cast<unsigned long long>(reader.message_count()),
      reader.is_complete() ? "" : "; its end is missing: who wrote it was killed, or still writes");
  for (const std::string& problem : reader.problems()) {
    std::printf("%s\n", printable(problem, problem.size()).c_str());
  }
}

}  // namespace

int show_recording(const InfoArguments& arguments) {
  const recording::Reader reader(arguments.file);
  if (arguments.json) {
    print_json(json_of_recording(reader), true);
  } else {
    print_recording(reader);
  }
  if (reader.message_count() > 0) return 0;
  std::fprintf(stderr, "skein: %s holds nothing: %s\n",
               printable(arguments.file, kLongestPath).c_str(),
               std::filesystem::file_size(arguments.file) == 0 ? "the file is empty"
               : reader.is_complete()                          ? "nothing was recorded"
                                                               : "it was cut off");
  return 1;
}

}  // namespace skein::command
