#include "profile/check.hpp"

#include <algorithm>
#include <cstdio>

#include "commands.hpp"
#include "launch/launch_plan.hpp"
#include "launch/machine_check.hpp"
#include "launch/supervisor.hpp"

namespace skein::command {
namespace {

std::vector<profile::Finding> findings_of(const CheckArguments& arguments) {
  auto findings = profile::check_file(arguments.profile);
  // Of a profile with gaps it cannot be said what it needs here.
  if (profile::has_errors(findings)) return findings;
  const auto mission = profile::read_mission_profile(arguments.profile);
  const bool nobody_here = std::ranges::none_of(
      mission.peers, [&](const auto& peer) { return launch::is_here(peer.host, arguments.host); });
  if (nobody_here) {
    findings.push_back({profile::Severity::Warning, mission.peers.front().where,
                        launch::nobody_here(mission, arguments.host), ""});
  }
  for (const auto& more : {launch::check_machine(mission, arguments.host),
                           launch::check_hosts(mission, arguments.host),
                           launch::check_plugins(mission, arguments.host)}) {
    findings.insert(findings.end(), more.begin(), more.end());
  }
  return findings;
}

}  // namespace

int check(const CheckArguments& arguments) {
  const auto findings = findings_of(arguments);
  std::fputs(profile::to_text(findings).c_str(), stderr);
  if (profile::has_errors(findings)) return launch::kConfigurationError;
  std::printf("%s: complete: every dependency is resolved\n", arguments.profile.c_str());
  return 0;
}

}  // namespace skein::command
