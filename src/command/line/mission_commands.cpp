#include "command/commands.hpp"
#include "command_line.hpp"
#include "mission/process/exit_codes.hpp"
#include "mission/profile/mission_profile.hpp"

// What checks missions and flies them.
namespace skein::command {

Subcommands mission_commands;

namespace {

CLI::Option* add_profile(CLI::App& command, std::string& profile) {
  return command.add_option("PROFILE", profile, "Mission profile (XML)")->type_name(kFile);
}

CLI::Option* add_host(CLI::App& command, std::string& host) {
  return command
      .add_option("--host", host, "Which host of the profile this is; default: as names tell")
      ->type_name("NAME");
}

void add_mission(CLI::App& command, MissionArguments& arguments) {
  add_profile(command, arguments.profile)->required();
  command
      .add_option("--set", arguments.settings,
                  "A parameter's value for this run: PEER.PARAMETER=VALUE or "
                  "PEER/CSP.PARAMETER=VALUE; may be given several times; default: the profile's")
      ->type_name("SETTING")
      ->check(of_form([](const std::string& text) { profile::demand_setting(text); }));
  add_variables(command, arguments.variables);
}

void add_plan(CLI::App& command, PlanArguments& arguments) {
  add_mission(command, arguments);
  add_host(command, arguments.host);
  command
      .add_option("--only", arguments.only,
                  "A peer, or a group of peers, to start; may be given several times; default: all")
      ->type_name("NAME")
      ->allow_extra_args(false);
}

void add_process(CLI::App& command, std::string& process) {
  command.add_option("PROCESS", process, "A peer, or PEER/CSP for a CSP's own process")
      ->type_name("NAME")
      ->required();
}

void add_check(CLI::App& app, int& result) {
  auto& command =
      add_command(app, "check", "Check a mission profile and all that it names",
                  {{"skein check mission.xml", "Every gap, with file, line and column"},
                   {"skein check --host uav-1 mission.xml", "What is missing on that host"},
                   {"skein check --json mission.xml", "The same, for an editor or a script"}});
  auto& arguments = arguments_of(command, check, result);
  add_mission(command, arguments);
  command
      .add_option(
          "--text", arguments.text,
          "A file with what the profile will hold, such as an editor's; default: the profile")
      ->type_name(kFile);
  add_host(command, arguments.host);
  add_json(command, arguments.json);
  add_exit_codes(command, launch::kPlanning);
}
const SubcommandRow kCheckRow(mission_commands, add_check);

void add_doctor(CLI::App& app, int& result) {
  auto& command = add_command(
      app, "doctor",
      "Find what on this machine keeps peers from speaking to each other\n\n"
      "Looks at network interfaces, firewall, UDP buffers and ports, other missions, DDS vendors, "
      "clock, shared memory and limits, and lets two peers find each other. With a "
      "profile also at what `skein check` finds, and at which peers of the mission answer.",
      {{"skein doctor", "This machine, for missions that stay on it"},
       {"skein doctor --interface eth0", "For missions on a network"},
       {"skein doctor mission.xml", "For this mission, also while it flies"}});
  auto& arguments = arguments_of(command, examine, result);
  add_profile(command, arguments.profile)
      ->description("Mission profile (XML); default: none, this machine alone");
  command
      .add_option("--domain", arguments.domain,
                  "DDS domain; default: the profile's; without one SKEIN_DOMAIN, or 0")
      ->type_name("NUMBER")
      ->check(domain_number());
  command
      .add_option("--interface", arguments.interface,
                  "Network interface; default: the profile's, or loopback")
      ->type_name(kInterface);
  add_host(command, arguments.host);
  add_variables(command, arguments.variables);
  add_json(command, arguments.json, "an object with the list `findings`");
  add_exit_codes(command, launch::kDoctor);
}
const SubcommandRow kDoctorRow(mission_commands, add_doctor);

void add_launch(CLI::App& app, int& result) {
  auto& command = add_command(
      app, "launch", "Fly a mission: each peer in a process of its own",
      {{"skein launch mission.xml", "Start the peers of this host; end with the mission's peer"},
       {"skein launch --ssh mission.xml", "Those of the mission's other hosts, too"},
       {"skein launch --dry-run mission.xml", "Only say what would run"},
       {"skein launch --only wing mission.xml", "Only the peers of the group wing"},
       {"skein launch --set navigator.grid=100 mission.xml", "With another value, for this run"}});
  auto& arguments = arguments_of(command, launch, result);
  add_plan(command, arguments);
  auto* ssh = command.add_flag("--ssh", arguments.ssh,
                               "Start the peers of the mission's other hosts, too, over ssh: by "
                               "your own configuration, without passwords");
  command
      .add_flag("--attended", arguments.attended,
                "Obey another launcher on standard input, and report on standard output: what "
                "--ssh runs on other hosts")
      ->excludes(ssh);
  command.add_flag("--dry-run", arguments.dry_run, "Only say what would run");
  command.add_flag("--verbose", arguments.verbose,
                   "Show the start, readiness and end of each process");
  auto* no_log = command.add_flag("--no-log", arguments.no_log, "Keep no logs");
  command
      .add_option("--log-folder", arguments.log_folder,
                  "Folder of the logs; default: the profile's logs=, or "
                  "~/.local/state/skein/MISSION-DOMAIN")
      ->type_name(kDirectory)
      ->excludes(no_log);
  command.add_option("--log-size", arguments.log_size, "Size at which a log begins a new file")
      ->type_name("MIB")
      ->capture_default_str()
      ->check(CLI::Validator(CLI::Range(1, 1 << 20)).description(""));
  command.add_option("--log-files", arguments.log_files, "Files that are kept of each log")
      ->type_name("COUNT")
      ->capture_default_str()
      ->check(CLI::Validator(CLI::Range(1, 1000)).description(""));
  add_exit_codes(command, launch::kLaunch);
}
const SubcommandRow kLaunchRow(mission_commands, add_launch);

void add_peer(CLI::App& app, int& result) {
  auto& command = add_command(
      app, "peer", "Run one process of a mission",
      {{"skein peer mission.xml navigator", "As `skein launch` would start it, by itself"},
       {"skein peer mission.xml navigator/AStar", "A CSP that has a process of its own"}});
  auto& arguments = arguments_of(command, run_peer, result);
  add_mission(command, arguments);
  add_process(command, arguments.process);
  command
      .add_option(
          "ARGUMENT", arguments.words,
          "For its components to read; after -- where one begins with a dash; default: none")
      ->type_name("WORD");
}
const SubcommandRow kPeerRow(mission_commands, add_peer);

CLI::Option* add_running(CLI::App& command, RunningArguments& arguments) {
  CLI::Option* profile = add_profile(command, arguments.profile);
  add_variables(command, arguments.variables)->needs(profile);
  add_host(command, arguments.host)->needs(profile);
  add_exit_codes(command, launch::kAsking);
  return profile;
}

void add_restart(CLI::App& app, int& result) {
  auto& command = add_command(
      app, "restart", "Start a process of a running mission anew",
      {{"skein restart mission.xml navigator", "Also if it was given up: restarts count anew"}});
  auto& arguments = arguments_of(command, restart_process, result);
  add_running(command, arguments)->required();
  add_process(command, arguments.process);
}
const SubcommandRow kRestartRow(mission_commands, add_restart);

void add_status(CLI::App& app, int& result) {
  auto& command =
      add_command(app, "status", "Show what the launcher of a running mission knows",
                  {{"skein status", "Of all missions that you fly here"},
                   {"skein status mission.xml", "State, process, restarts and last end of each"}});
  auto& arguments = arguments_of(command, show_status, result);
  add_running(command, arguments)
      ->description("Mission profile (XML); default: all missions that this user flies here");
  add_json(command, arguments.json);
}
const SubcommandRow kStatusRow(mission_commands, add_status);

void add_script(CLI::App& app, int& result) {
  auto& command = add_command(app, "script", "Write a mission as a shell script",
                              {{"skein script mission.xml --output start.sh",
                                "A script that starts it without Skein's launcher"}});
  auto& arguments = arguments_of(command, write_script, result);
  add_plan(command, arguments);
  command.add_option("--output", arguments.output, "The script's file; default: standard output")
      ->type_name(kFile);
  add_exit_codes(command, launch::kPlanning);
}
const SubcommandRow kScriptRow(mission_commands, add_script);

void add_names(CLI::App& command, const std::string& option, std::vector<std::string>& names,
               const std::string& what, const char* type) {
  command.add_option(option, names, what + "; may be given several times; default: none")
      ->type_name(type)
      ->allow_extra_args(false);
}

void add_new(CLI::App& app, int& result) {
  auto& command = add_command(
      app, "new",
      "Begin a component: source that compiles, its description, and its project\n\n"
      "An interface is looked for in the files and folders that are named, in the present folder, "
      "and in Skein's own IDL.",
      {{"skein new entity Lookout", "An entity with a new interface, and a mission to try it"},
       {"skein new entity Lookout --operations 'double seen(in string what);'",
        "The same, with that operation"},
       {"skein new csp Spiral --implements survey::IPlanner --idl survey.idl",
        "One more algorithm for an interface that is there"},
       {"skein new activity Watch --needs survey::INavigator", "Code that only calls others"}});
  auto& arguments = arguments_of(command, begin_component, result);
  const std::vector<std::string> kinds{"entity", "csp", "activity"};
  command.add_option("KIND", arguments.kind, "Of the component: " + one_of(kinds))
      ->type_name(one_of(kinds))
      ->check(known_word(kinds))
      ->required();
  command.add_option("NAME", arguments.name, "The component and its class, such as Lookout")
      ->type_name("NAME")
      ->required();
  auto* there = command
                    .add_option("--implements", arguments.implements,
                                "The interface that it implements; default: a new one")
                    ->type_name("INTERFACE-NAME");
  command
      .add_option("--operations", arguments.operations,
                  "The operations of its new interface, in IDL; default: one to begin with")
      ->type_name("IDL")
      ->excludes(there);
  add_names(command, "--needs", arguments.needs, "An interface of others that it calls",
            "INTERFACE-NAME");
  add_names(command, "--csps", arguments.csps, "An interface that CSPs of this entity implement",
            "INTERFACE-NAME");
  add_names(command, "--idl", arguments.idl, "A file with such an interface", kFile);
  add_names(command, "--idl-folder", arguments.folders,
            "A folder with such files, and with those that they include", kDirectory);
  command
      .add_option("--folder", arguments.folder,
                  "The folder in which the component gets its own; default: the present one")
      ->type_name(kDirectory);
  add_exit_codes(command, launch::kPlanning);
}
const SubcommandRow kNewRow(mission_commands, add_new);

/// Hidden: `launch --ssh` runs it.
void add_attend(CLI::App& app, int& result) {
  auto& command = add_command(app, "attend", "Fly another host's part of a mission over ssh", {});
  command.group("");
  auto& arguments = arguments_of(command, attend, result);
  add_plan(command, arguments);
  command.add_flag("--verbose", arguments.verbose,
                   "Show the start, readiness and end of each process");
}
const SubcommandRow kAttendRow(mission_commands, add_attend);

}  // namespace
}  // namespace skein::command
