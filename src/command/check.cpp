#include "profile/check.hpp"

#include <cstdio>

#include "commands.hpp"
#include "launch/machine_check.hpp"
#include "launch/supervisor.hpp"

namespace skein::command {

namespace {

struct Arguments {
  std::string profile;
  std::string host;
};

std::vector<profile::Finding> findings_of(const Arguments& arguments) {
  auto findings = profile::check_file(arguments.profile);
  // Of a profile with gaps it cannot be said what it needs here.
  if (profile::has_errors(findings)) return findings;
  const auto mission = profile::read_mission_profile(arguments.profile);
  for (const auto& more : {launch::check_machine(mission, arguments.host),
                           launch::check_hosts(mission, arguments.host),
                           launch::check_plugins(mission, arguments.host)}) {
    findings.insert(findings.end(), more.begin(), more.end());
  }
  return findings;
}

}  // namespace

void add_check(CLI::App& app, int& result) {
  auto* command = app.add_subcommand("check", "Check a mission profile and all that it names");
  auto arguments = std::make_shared<Arguments>();
  command->add_option("PROFILE", arguments->profile, "Mission profile (XML)")->required();
  command->add_option("--host", arguments->host,
                      "Which host of the profile this is, where names do not tell");
  command->callback([arguments, &result] {
    const auto findings = findings_of(*arguments);
    std::fputs(profile::to_text(findings).c_str(), stderr);
    const bool refused = profile::has_errors(findings);
    if (!refused) {
      std::printf("%s: complete: every dependency is resolved\n", arguments->profile.c_str());
    }
    result = refused ? launch::kConfigurationError : 0;
  });
}

}  // namespace skein::command
