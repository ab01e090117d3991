#include <unistd.h>

#include <cstdio>
#include <filesystem>

#include "commands.hpp"
#include "skein/launch/peer.hpp"
#include "skein/launch/supervisor.hpp"
#include "skein/profile/check.hpp"

namespace skein::command {
namespace {

struct Arguments {
  std::string profile;
  std::string process;
  std::vector<std::string> settings;
  bool dry_run = false;
};

void add_common(CLI::App& command, Arguments& arguments) {
  command.add_option("PROFILE", arguments.profile, "Mission profile (XML)")->required();
  command.add_option("--set", arguments.settings,
                     "A parameter's value for this run: PEER.PARAMETER=VALUE or PEER/CSP.PARAMETER=VALUE");
}

profile::MissionProfile read(const Arguments& arguments) {
  auto mission = profile::read_checked_profile(arguments.profile);
  for (const std::string& setting : arguments.settings) profile::apply_setting(mission, setting);
  return mission;
}

std::vector<std::string> command_line(const Arguments& arguments, const profile::PeerProfile& peer,
                                      const profile::CspProfile* csp) {
  std::vector<std::string> argv{std::filesystem::read_symlink("/proc/self/exe").string(), "peer",
                                arguments.profile, csp ? peer.name + "/" + csp->name : peer.name};
  for (const std::string& setting : arguments.settings) {
    argv.push_back("--set");
    argv.push_back(setting);
  }
  return argv;
}

int launch(const Arguments& arguments) {
  const auto plan = launch::make_launch_plan(
      read(arguments), [&](const profile::PeerProfile& peer, const profile::CspProfile* csp) {
        return command_line(arguments, peer, csp);
      });
  if (arguments.dry_run) {
    std::fputs(launch::to_text(plan).c_str(), stdout);
    return 0;
  }
  launch::Supervisor supervisor(plan);
  const launch::LaunchResult outcome = supervisor.run();
  std::fprintf(outcome.exit_code == 0 ? stdout : stderr, "skein: %s\n", outcome.reason.c_str());
  return outcome.exit_code;
}

}  // namespace

void add_launch(CLI::App& app, int& result) {
  auto* command = app.add_subcommand("launch", "Fly a mission: each peer in a process of its own");
  auto arguments = std::make_shared<Arguments>();
  add_common(*command, *arguments);
  command->add_flag("--dry-run", arguments->dry_run, "Only say what would run");
  command->callback([arguments, &result] { result = launch(*arguments); });
}

void add_peer(CLI::App& app, int& result) {
  auto* command = app.add_subcommand("peer", "Run one process of a mission");
  auto arguments = std::make_shared<Arguments>();
  add_common(*command, *arguments);
  command->add_option("PROCESS", arguments->process, "A peer, or PEER/CSP for a CSP's own process")->required();
  command->callback([arguments, &result] {
    ComponentRegistry registry;
    result = launch::run_process(read(*arguments), arguments->process, registry);
  });
}

}  // namespace skein::command
