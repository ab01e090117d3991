#include "command/commands.hpp"
#include "command_line.hpp"

// What looks at a domain while it runs, or at what was recorded of it.
namespace skein::command {

Subcommands inspection_commands;

namespace {

void add_watching(CLI::App& command, double& seconds) {
  add_duration(command, "--for", seconds, "How long to watch; default: until interrupted",
               Zero::Refused);
}

void add_entity(CLI::App& command, std::string& entity, const std::string& what) {
  command.add_option("--entity", entity, what + " NAME or SYSTEM/NAME; default: all")
      ->type_name(kEntity);
}

void add_calls(CLI::App& app, int& result) {
  auto& command =
      add_command(app, "calls", "Show what happens to each call on a domain, live",
                  {{"skein calls --domain 47", "Each step of each call, until Ctrl-C"},
                   {"skein calls --profile mission.xml --for 10", "Ten seconds of a mission"}});
  auto& arguments = arguments_of(command, show_calls, result);
  add_onlooker(command, arguments);
  add_entity(command, arguments.entity, "Steps that this entity tells of:");
  add_watching(command, arguments.seconds);
  add_json(command, arguments.json, "each step a line");
  add_exit_codes(command);
}
const SubcommandRow kCallsRow(inspection_commands, add_calls);

void add_decisions(CLI::App& app, int& result) {
  auto& command = add_command(
      app, "decisions",
      "Show how the Heads on a domain decide, live or from a log\n\n"
      "Live, it prints each decision from now on, and nothing until the next one; those "
      "before are in a Head's log. Of a log that was cut off, whole lines are read; at its end, "
      "features of tasks that never help are told.",
      {{"skein decisions --domain 47", "Why each CSP was chosen, until Ctrl-C"},
       {"skein decisions --domain 47 --entity navigator", "Of one Head"},
       {"skein decisions --log decisions.jsonl", "The same, of a past mission"},
       {"skein decisions --log decisions.jsonl --replay",
        "Make the choices again; exit code 1 where one comes out differently"}});
  auto& arguments = arguments_of(command, show_decisions, result);
  add_onlooker(command, arguments);
  add_entity(command, arguments.entity, "Decisions of this entity's Head:");
  add_watching(command, arguments.seconds);
  auto* log =
      command
          .add_option("--log", arguments.log, "A Head's log to read; default: look at the domain")
          ->type_name(kFile);
  auto* replays = command.add_flag("--replay", arguments.replays,
                                   "Make the choices of the log again and tell of any difference");
  replays->needs(log);
  add_json(command, arguments.json,
           "each record a line, as in a log; with --replay each that differs, and the counts");
  command
      .add_option("--plugin", arguments.plugins,
                  "A plugin whose selection strategies were used; may be given several times; "
                  "default: Skein's own strategies alone")
      ->type_name("NAME")
      ->needs(replays);
  add_exit_codes(command);
}
const SubcommandRow kDecisionsRow(inspection_commands, add_decisions);

/// The port at which a command serves, and the token of its URL.
void add_server(CLI::App& command, std::uint16_t& port, std::string& token, const char* variable) {
  command.add_option("--port", port, "TCP port on loopback; 0 takes any that is free")
      ->type_name("PORT")
      ->capture_default_str();
  command
      .add_option("--token", token,
                  "What the URL must contain, at least 16 letters and digits, which others can see "
                  "on the command line, but not in the environment; default: a random one")
      ->type_name("TOKEN")
      ->envname(variable);
}

void add_designer(CLI::App& app, int& result) {
  auto& command = add_command(
      app, "designer",
      "Compose a mission on a page, or watch one, live or recorded\n\n"
      "Entities are boxes with their CSPs. To compose, drop components there; what the mission "
      "lacks is told as `skein check` finds it; the file keeps all that nobody changes. While a "
      "mission flies, lines between boxes are calls and topics, with rates, "
      "latencies and transports; what a profile has and nobody has seen is dashed. "
      "Processes of missions that this user flies here can be restarted, and missions be stopped. "
      "What the page shows is at state.json beside it, for programs. Boxes are placed by Graphviz "
      "(package graphviz).",
      {{"skein designer mission.xml", "Compose a mission; the file need not be there yet"},
       {"skein designer mission.xml --components /opt/boat/components",
        "The same, with components of another folder"},
       {"skein designer --watch --domain 47", "A mission that somebody has started"},
       {"skein designer --watch --profile mission.xml", "The same, over what the profile expects"},
       {"skein designer --watch --profile mission.xml --faults",
        "A simulated mission, whose processes may be killed"},
       {"skein designer --replay flight.mcap", "What was recorded, with a slider for the time"}});
  auto& arguments = arguments_of(command, serve_designer, result);
  auto* composed =
      command
          .add_option("PROFILE", arguments.composed,
                      "The mission profile (XML) that is composed, or will be; default: none")
          ->type_name(kFile);
  auto* watch = command
                    .add_flag("--watch", arguments.watch,
                              "Show a mission that somebody starts, while it flies")
                    ->excludes(composed);
  auto* replay = command
                     .add_option("--replay", arguments.replay,
                                 "Show a recording that `skein record` has made; default: none")
                     ->type_name(kFile)
                     ->excludes(watch)
                     ->excludes(composed);
  command
      .add_option(
          "--components", arguments.components,
          "A folder with component descriptions, also in folders in it; may be given several "
          "times; default: only those beside the profile and Skein's own")
      ->type_name("FOLDER")
      ->check(CLI::Validator(CLI::ExistingDirectory).description(""))
      ->needs(composed)
      ->allow_extra_args(false);
  add_onlooker(command, arguments);
  auto* profile = command.get_option("--profile")->excludes(composed);
  for (const char* option : {"--domain", "--interface"})
    command.get_option(option)->excludes(composed);  // the profile tells them
  auto* variables = command.get_option("--variable");
  variables->remove_needs(profile);
  command.parse_complete_callback([=] {
    if (composed->count() + watch->count() + replay->count() == 0)
      throw CLI::RequiredError("A profile, --watch or --replay");
    if (variables->count() > 0 && composed->count() + profile->count() == 0)
      throw CLI::RequiresError(variables->get_name(), "a profile");
  });
  add_server(command, arguments.port, arguments.token, "SKEIN_DESIGNER_TOKEN");
  command.add_flag("--faults", arguments.faults,
                   "Let those who look kill processes and make them hang, to see what the mission "
                   "bears: for missions in which nothing real can break");
  command.add_flag("--no-browser", arguments.no_browser,
                   "Open no browser; default: the desktop's, if there is one");
  add_exit_codes(command);
}
const SubcommandRow kDesignerRow(inspection_commands, add_designer);

void add_graph(CLI::App& app, int& result) {
  auto& command = add_command(
      app, "graph", "Draw who speaks to whom on a domain now",
      {{"skein graph --domain 47 --format svg > mission.svg", "A picture, by Graphviz"},
       {"skein graph --domain 47 --format mermaid", "Text for a README or an issue"},
       {"skein graph --profile mission.xml --format json", "Nodes and edges, for programs"}});
  auto& arguments = arguments_of(command, draw_graph, result);
  add_onlooker(command, arguments);
  const std::vector<std::string> formats{"dot", "mermaid", "json", "svg", "png"};
  auto* format = command
                     .add_option("--format", arguments.format,
                                 "The notation; svg and png need the package graphviz")
                     ->type_name(one_of(formats))
                     ->check(known_word(formats))
                     ->capture_default_str();
  command.add_flag("--tools", arguments.tools, "Show Skein's own commands, too");
  add_wait(command, arguments.seconds);
  add_json(command, arguments.json, "as --format json")->excludes(format);
  add_exit_codes(command);
}
const SubcommandRow kGraphRow(inspection_commands, add_graph);

void add_log(CLI::App& app, int& result) {
  auto& command = add_command(
      app, "log",
      "Show what the entities of a domain log, live\n\n"
      "First come the latest lines that each process has logged before, at most 256. The "
      "variable SKEIN_LOG in a process's environment sets the least level that it logs: debug, "
      "info (the default), warning or error.",
      {{"skein log --domain 47", "All lines, until Ctrl-C"},
       {"skein log --entity navigator --level warning", "Warnings and errors of one process"}});
  auto& arguments = arguments_of(command, show_log, result);
  add_onlooker(command, arguments);
  add_entity(command, arguments.entity, "Lines of this entity's process:");
  command
      .add_option("--level", arguments.level,
                  "The least that is shown: debug, info, warning, error")
      ->check(CLI::IsMember({"debug", "info", "warning", "error"}).description(""))
      ->type_name("LEVEL")
      ->capture_default_str();
  add_watching(command, arguments.seconds);
  add_json(command, arguments.json, "each line a line");
  add_exit_codes(command);
}
const SubcommandRow kLogRow(inspection_commands, add_log);

void add_peers(CLI::App& app, int& result) {
  auto& command =
      add_command(app, "peers", "List who is on a domain now",
                  {{"skein peers --domain 47", "Each peer with its process and its services"},
                   {"skein peers --profile mission.xml --json", "The same, for programs"}});
  auto& arguments = arguments_of(command, list_peers, result);
  add_onlooker(command, arguments);
  add_wait(command, arguments.seconds);
  add_json(command, arguments.json, "a list");
  add_exit_codes(command);
}
const SubcommandRow kPeersRow(inspection_commands, add_peers);

void add_services(CLI::App& app, int& result) {
  auto& command = add_command(
      app, "services", "List what is provided on a domain now",
      {{"skein services --domain 47", "Who provides what, with which attributes"},
       {"skein services --domain 47 --statistics",
        "What became of the calls, their times, and the way that each client takes"},
       {"skein services --interface eth0 --multicast", "On a network, not within this host"}});
  auto& arguments = arguments_of(command, list_services, result);
  add_onlooker(command, arguments);
  command.add_flag(
      "--statistics", arguments.statistics,
      "Show what became of the calls of each service, how long they took, and by which "
      "transport its clients reach it, with the reason where a faster one is not taken");
  add_wait(command, arguments.seconds);
  add_json(command, arguments.json, "a list");
  add_exit_codes(command);
}
const SubcommandRow kServicesRow(inspection_commands, add_services);

void add_top(CLI::App& app, int& result) {
  auto& command = add_command(
      app, "top",
      "Watch peers, services and decisions of a domain on a whole screen\n\n"
      "Shows what each process uses, how often each service is called and how long its slowest "
      "operation runs (the 50th and 99th percentile since it began), and the latest decisions of "
      "Heads. Keys: q leaves; arrows, j, k and page keys scroll; tab goes from peers to services; "
      "n, c, m, r and l sort by name, CPU, memory, calls and p99. Where NO_COLOR is set there is "
      "no "
      "colour; on a dumb terminal, and into a pipe, frames follow each other as text.",
      {{"skein top --domain 47", "Until q or Ctrl-C"},
       {"skein top --profile mission.xml --once", "One frame as plain text, of all rows"}});
  auto& arguments = arguments_of(command, show_top, result);
  add_onlooker(command, arguments);
  add_duration(command, "--every", arguments.every, "How often it looks again", Zero::Refused)
      ->default_str(default_duration(arguments.every));
  auto* once = command.add_flag("--once", arguments.once,
                                "Print one frame as plain text, after three seconds");
  add_json(command, arguments.json, "one frame")->needs(once);
  command.add_flag("--tools", arguments.tools, "Show Skein's own commands, too");
  add_exit_codes(command);
}
const SubcommandRow kTopRow(inspection_commands, add_top);

void add_view(CLI::App& app, int& result) {
  auto& command =
      add_command(app, "view", "Show a domain to Lichtblick or Foxglove, live",
                  {{"skein view --domain 47", "Prints the URL to open there, until Ctrl-C"},
                   {"skein view --profile mission.xml --port 9000", "A mission, on another port"}});
  auto& arguments = arguments_of(command, serve_view, result);
  add_onlooker(command, arguments);
  add_server(command, arguments.port, arguments.token, "SKEIN_VIEW_TOKEN");
  command
      .add_option("--origin", arguments.origins,
                  "A web page that may look, such as http://localhost:8080; may be given several "
                  "times; default: all pages that know the token")
      ->type_name("URL");
  command.add_flag("--calls", arguments.calls,
                   "Let those who look also call services: they can then steer the mission");
  add_exit_codes(command);
}
const SubcommandRow kViewRow(inspection_commands, add_view);

}  // namespace
}  // namespace skein::command
