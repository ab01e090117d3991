#include <CLI/CLI.hpp>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <iostream>
#include <memory>
#include <string>
#include <vector>

#include "commands.hpp"
#include "core/printable.hpp"
#include "core/suggestion.hpp"
#include "dds/vendor_names.hpp"
#include "launch/address_space.hpp"
#include "launch/supervisor.hpp"
#include "profile/finding.hpp"
#include "skein/error.hpp"

// The command line of `skein`. No other unit includes CLI11, which takes long to compile.
namespace skein::command {
namespace {

constexpr std::size_t kLongestError = 4096;

/// Makes `command` run `function`, whose exit code becomes `result`. Returns the arguments for its
/// options to fill.
template <typename Arguments>
Arguments& arguments_of(CLI::App& command, int (*function)(const Arguments&), int& result) {
  const auto arguments = std::make_shared<Arguments>();
  command.callback([arguments, function, &result] { result = function(*arguments); });
  return *arguments;
}

BenchArguments& add_measurement(CLI::App& command, int (*function)(const BenchArguments&),
                                int& result) {
  auto& arguments = arguments_of(command, function, result);
  auto* vendor =
      command.add_option("--vendor", arguments.vendor, dds::alternatives(dds::networked_vendors()))
          ->capture_default_str();
  command.add_option("--domain", arguments.domain, "DDS domain")->capture_default_str();
  auto* interface = command.add_option("--interface", arguments.interface,
                                       "Network interface; loopback by default");
  command.add_option("--peer", arguments.peer,
                     "The other host's address, with an interface of this one");
  auto* profile =
      command
          .add_option("--profile", arguments.profile,
                      "Mission profile whose peers' vendor, interface, shared memory, threads and "
                      "spinning are measured")
          ->check(CLI::ExistingFile)
          ->excludes(vendor)
          ->excludes(interface);
  command
      .add_option("--provider", arguments.provider,
                  "Peer of the profile that is called; its first by default")
      ->needs(profile);
  command
      .add_option("--caller", arguments.caller,
                  "Peer of the profile that calls; the provider by default")
      ->needs(profile);
  auto* serve = command.add_flag("--serve", arguments.serve, "Be the other side, until ended");
  command.add_flag("--remote", arguments.remote, "The other side runs already (--serve)")
      ->excludes(serve);
  command.add_option("--output", arguments.output, "JSON file for `skein bench compare`");
  return arguments;
}

void add_load(CLI::App& command, BenchArguments& arguments) {
  command
      .add_option("--payload", arguments.payloads,
                  "Octets each way; several are measured one by one")
      ->capture_default_str();
  command.add_option("--count", arguments.count, "Calls; fewer of great payloads")
      ->capture_default_str()
      ->check(CLI::PositiveNumber);
}

void add_bench(CLI::App& app, int& result) {
  auto& command =
      *app.add_subcommand("bench", "Measure calls on this machine, or between two hosts");
  command.require_subcommand(1);
  auto& latency = *command.add_subcommand("latency", "One call after the other");
  add_load(latency, add_measurement(latency, bench_latency, result));
  auto& throughput = *command.add_subcommand("throughput", "Time per call with many in flight");
  auto& of_throughput = add_measurement(throughput, bench_throughput, result);
  add_load(throughput, of_throughput);
  throughput.add_option("--in-flight", of_throughput.in_flight, "Calls in flight")
      ->capture_default_str()
      ->check(CLI::PositiveNumber);
  add_measurement(*command.add_subcommand("discovery", "From an entity's start to its first reply"),
                  bench_discovery, result);
  auto& compare = *command.add_subcommand("compare", "Two saved results beside each other");
  auto& files = arguments_of(compare, bench_compare, result);
  compare.add_option("A", files.before, "Result")->required()->check(CLI::ExistingFile);
  compare.add_option("B", files.after, "Result to divide by A's")
      ->required()
      ->check(CLI::ExistingFile);
}

void add_onlooker(CLI::App& command, Onlooker& onlooker) {
  command.add_option("--vendor", onlooker.vendor, dds::alternatives(dds::networked_vendors()))
      ->capture_default_str();
  auto* domain = command.add_option("--domain", onlooker.domain, "DDS domain of the mission")
                     ->capture_default_str();
  auto* interface = command.add_option("--interface", onlooker.interface,
                                       "Network interface; loopback by default");
  command.add_option("--peers", onlooker.peers, "Hosts to ask for peers, beside this one")
      ->delimiter(',')
      ->needs(interface);
  command.add_flag("--multicast", onlooker.multicast, "Find peers by multicast")->needs(interface);
  auto* profile =
      command
          .add_option("--profile", onlooker.profile,
                      "Mission profile: domain and network are those of its peers on this host")
          ->excludes(domain)
          ->excludes(interface);
  command
      .add_option("--host", onlooker.host,
                  "Which host of the profile this is, where names do not tell")
      ->needs(profile);
}

void add_calls(CLI::App& app, int& result) {
  auto& command = *app.add_subcommand("calls", "Show what happens to each call on a domain, live");
  auto& arguments = arguments_of(command, show_calls, result);
  add_onlooker(command, arguments);
  command.add_option("--for", arguments.seconds, "Seconds to watch; until interrupted by default");
}

void add_check(CLI::App& app, int& result) {
  auto& command = *app.add_subcommand("check", "Check a mission profile and all that it names");
  auto& arguments = arguments_of(command, check, result);
  command.add_option("PROFILE", arguments.profile, "Mission profile (XML)")->required();
  command.add_option("--host", arguments.host,
                     "Which host of the profile this is, where names do not tell");
}

void add_decisions(CLI::App& app, int& result) {
  auto& command =
      *app.add_subcommand("decisions", "Show how the Heads on a domain decide, live or from a log");
  auto& arguments = arguments_of(command, show_decisions, result);
  add_onlooker(command, arguments);
  command.add_option("--for", arguments.seconds, "Seconds to watch; until interrupted by default");
  auto* log = command.add_option("--log", arguments.log, "Read a Head's log instead");
  auto* replays = command.add_flag("--replay", arguments.replays,
                                   "Make the choices of the log again and tell of any difference");
  replays->needs(log);
  command
      .add_option("--plugin", arguments.plugins,
                  "A plugin whose selection strategies were used; may be given several times")
      ->needs(replays);
}

void add_mission(CLI::App& command, MissionArguments& arguments) {
  command.add_option("PROFILE", arguments.profile, "Mission profile (XML)")->required();
  command.add_option(
      "--set", arguments.settings,
      "A parameter's value for this run: PEER.PARAMETER=VALUE or PEER/CSP.PARAMETER=VALUE");
}

void add_launch(CLI::App& app, int& result) {
  auto& command = *app.add_subcommand("launch", "Fly a mission: each peer in a process of its own");
  auto& arguments = arguments_of(command, launch, result);
  add_mission(command, arguments);
  command.add_option("--host", arguments.host,
                     "Which host of the profile this is, where names do not tell");
  command.add_flag("--dry-run", arguments.dry_run, "Only say what would run");
  command.add_flag("--verbose", arguments.verbose,
                   "Show the start, readiness and end of each process");
}

void add_peer(CLI::App& app, int& result) {
  auto& command = *app.add_subcommand("peer", "Run one process of a mission");
  auto& arguments = arguments_of(command, run_peer, result);
  add_mission(command, arguments);
  command.add_option("PROCESS", arguments.process, "A peer, or PEER/CSP for a CSP's own process")
      ->required();
}

void add_services(CLI::App& app, int& result) {
  auto& command = *app.add_subcommand("services", "List what is provided on a domain now");
  auto& arguments = arguments_of(command, list_services, result);
  add_onlooker(command, arguments);
  command.add_flag("--statistics", arguments.statistics,
                   "Show what became of the calls of each service, and how long they took");
  command.add_option("--wait", arguments.seconds, "Seconds to listen")->capture_default_str();
}

void complain(const std::string& text) { std::fprintf(stderr, "skein: %s\n", text.c_str()); }

/// CLI11 would say that a command is missing, and not that there is none of that name.
void refuse_unknown_command(const CLI::App& app, int argc, char** argv) {
  if (argc < 2 || argv[1][0] == '-') return;
  std::vector<std::string> known;
  std::string list;
  for (const CLI::App* command : app.get_subcommands({})) {
    known.push_back(command->get_name());
    list += (list.empty() ? "" : ", ") + known.back();
    if (known.back() != argv[1]) continue;
    if (command->get_require_subcommand_min() > 0)
      refuse_unknown_command(*command, argc - 1, argv + 1);
    return;
  }
  const std::string name = app.get_parent() ? app.get_name() : "";
  throw InvalidArgument("there is no command '" + (name.empty() ? "" : name + " ") +
                        printable(argv[1]) + "'" + suggestion(argv[1], known) + "; known are " +
                        list);
}

int run(CLI::App& app, int argc, char** argv, const int& result) {
  try {
    refuse_unknown_command(app, argc, argv);
    app.parse(argc, argv);
    return result;
  } catch (const CLI::ParseError& error) {
    return app.exit(error);
  } catch (const profile::DescriptionError& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return launch::kConfigurationError;
  } catch (const InvalidArgument& error) {
    complain(printable(error.what(), kLongestError));
    return launch::kConfigurationError;
  } catch (const Error& error) {
    complain(printable(error.what(), kLongestError));
    return launch::kStartFailed;
  } catch (const std::exception& error) {  // what the system or the standard library refused
    const std::string limit = launch::address_space_limit();
    complain(printable(error.what(), kLongestError) + (limit.empty() ? "" : "; " + limit));
    return launch::kStartFailed;
  }
}

/// What was printed and did not arrive (a full disk, say) must not pass for success.
int with_output_checked(int code) {
  const bool failed_before = std::ferror(stdout) != 0;
  errno = 0;
  std::cout.flush();
  if (std::fflush(stdout) == 0 && !failed_before && std::cout.good()) return code;
  complain(std::string("the output could not be written: ") +
           (failed_before || errno == 0 ? "its reader has gone, or an earlier write failed"
                                        : std::strerror(errno)));
  return code == 0 ? launch::kOutputLost : code;
}

}  // namespace
}  // namespace skein::command

int main(int argc, char** argv) {
  using namespace skein::command;
  CLI::App app("Skein: autonomous entities on DDS");
  app.require_subcommand(1);
  app.set_version_flag("--version", SKEIN_VERSION);
  int result = 0;
  add_bench(app, result);
  add_calls(app, result);
  add_check(app, result);
  add_decisions(app, result);
  add_launch(app, result);
  add_peer(app, result);
  add_services(app, result);
  return with_output_checked(run(app, argc, argv, result));
}
