#include "command/commands.hpp"
#include "command_line.hpp"

// Recordings of missions.
namespace skein::command {

Subcommands recording_commands;

namespace {

void add_topic_filter(CLI::App& command, std::vector<std::string>& topics, const char* type) {
  command.add_option("--topics", topics, "Topics, with commas between them; default: all")
      ->type_name(type)
      ->delimiter(',');
}

void add_export(CLI::App& app, int& result) {
  auto& command = add_command(
      app, "export",
      "Write a recording for other programs\n\n"
      "Tables have a row for each value: its time in seconds since 1970 (`recorded_time` where a "
      "member is called `time`), then a column for each member that a value has, as PlotJuggler, "
      "pandas and spreadsheets read them. An array of more than 16 elements is one column of "
      "JSON.",
      {{"skein export flight.mcap --csv tables", "A table for each topic: tables/pose.csv, ..."},
       {"skein export flight.mcap --lines values.jsonl --topics pose,track",
        "JSON, a value a line"},
       {"skein export flight.mcap --perfetto flight.json",
        "Calls and decisions of all peers, for https://ui.perfetto.dev"}});
  auto& arguments = arguments_of(command, export_recording, result);
  command.add_option("FILE", arguments.file, "A recording")->type_name(kFile)->required();
  auto* csv =
      command.add_option("--csv", arguments.csv,
                         "The folder for a table of each topic, made if need be; default: none");
  auto* lines = command.add_option(
      "--lines", arguments.lines,
      "The file for all values, those of calls, too, as lines of JSON with topic and time; `-` is "
      "standard output; default: none");
  auto* perfetto = command.add_option("--perfetto", arguments.perfetto,
                                      "The file for a trace for Perfetto; default: none");
  csv->excludes(lines)->excludes(perfetto)->type_name(kFile);
  lines->excludes(perfetto)->type_name(kFile);
  perfetto->type_name(kFile);
  command.parse_complete_callback([csv, lines, perfetto] {
    if (csv->count() + lines->count() + perfetto->count() == 0)
      throw CLI::RequiredError("One of --csv, --lines and --perfetto");
  });
  add_topic_filter(command, arguments.topics, "NAMES");  // those of FILE, not of a domain
  command.get_option("--topics")->excludes(perfetto);
  add_json(command, arguments.json, "what was written");
  add_exit_codes(command);
}
const SubcommandRow kExportRow(recording_commands, add_export);

void add_info(CLI::App& app, int& result) {
  auto& command = add_command(app, "info", "Tell what a recording has",
                              {{"skein info flight.mcap", "Channels, counts, times, drops"}});
  auto& arguments = arguments_of(command, show_recording, result);
  command.add_option("FILE", arguments.file, "A recording")->type_name(kFile)->required();
  add_json(command, arguments.json);
  add_exit_codes(command);
}
const SubcommandRow kInfoRow(recording_commands, add_info);

void add_record(CLI::App& app, int& result) {
  auto& command = add_command(
      app, "record",
      "Record a mission while it flies\n\n"
      "Topics, calls with their arguments and results, and decisions go into a file in the MCAP "
      "format, which Lichtblick and Foxglove open. After a crash, what was written until a second "
      "before can be read. A call that never ran, or at which its provider died, has no arguments "
      "there, as the provider tells them when it ends.",
      {{"skein record --domain 42", "All of a mission, until Ctrl-C"},
       {"skein record --domain 42 --topics pose,track --only-topics --for 60", "Two topics alone"},
       {"skein record --profile mission.xml --output flight.mcap --split 500",
        "flight_0.mcap, flight_1.mcap, ..."}});
  auto& arguments = arguments_of(command, record, result);
  add_onlooker(command, arguments);
  command
      .add_option("--output", arguments.output,
                  "The file; default: mission_DATE_TIME.mcap, in this folder")
      ->type_name(kFile);
  add_topic_filter(command, arguments.topics, kTopic);
  command.add_flag("--only-topics", arguments.only_topics, "Neither calls nor decisions");
  add_duration(command, "--for", arguments.seconds, "How long; default: until interrupted",
               Zero::Refused);
  command
      .add_option("--split", arguments.split_megabytes,
                  "Begin a new file before one is larger than this; default: one file")
      ->type_name("MEGABYTES")
      ->check(above_zero());
  add_json(command, arguments.json, "what was recorded");
  add_exit_codes(command);
}
const SubcommandRow kRecordRow(recording_commands, add_record);

void add_replay(CLI::App& app, int& result) {
  auto& command = add_command(
      app, "replay",
      "Publish the topics of a recording again, or make its decisions again\n\n"
      "Where it is interrupted before all is published, it says how much was, and its exit code is "
      "128 + N for signal N.",
      {{"skein replay flight.mcap --domain 43", "In the recorded order and pace"},
       {"skein replay flight.mcap --rate 10 --topics pose --domain 43", "One topic, faster"},
       {"skein replay flight.mcap --decisions", "Exit code 1 where one comes out differently"}});
  auto& arguments = arguments_of(command, replay_recording, result);
  command.add_option("FILE", arguments.file, "A recording")->type_name(kFile)->required();
  add_onlooker(command, arguments);
  add_topic_filter(command, arguments.topics, "NAMES");  // those of FILE, not of a domain
  command.add_option("--rate", arguments.rate, "So many times as fast as it was recorded")
      ->check(above_zero())
      ->type_name("NUMBER")
      ->capture_default_str();
  auto* decisions = command.add_flag("--decisions", arguments.decisions,
                                     "Make the choices of the Heads again, bit for bit");
  command
      .add_option("--plugin", arguments.plugins,
                  "A plugin whose selection strategies were used; may be given several times; "
                  "default: Skein's own strategies alone")
      ->type_name("NAME")
      ->needs(decisions);
  add_json(command, arguments.json,
           "what was published; with --decisions a line for each that differs, and the counts");
  add_exit_codes(command);
}
const SubcommandRow kReplayRow(recording_commands, add_replay);

}  // namespace
}  // namespace skein::command
