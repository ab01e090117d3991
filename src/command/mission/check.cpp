#include "check.hpp"

#include <algorithm>
#include <cstdio>

#include "command/print/json_output.hpp"
#include "core/printable.hpp"
#include "mission/check/machine_check.hpp"
#include "mission/check/profile_check.hpp"
#include "mission/process/exit_codes.hpp"
#include "mission/supervise/launch_plan.hpp"
#include "mission/xml/text_file.hpp"

namespace skein::command {

CheckedMission check_mission(const PlanArguments& arguments, const std::string& text_file) {
  CheckedMission checked;
  auto& [mission, findings] = checked;
  std::string text;
  if (!text_file.empty()) text = profile::read_text_file(text_file);
  mission = profile::read_and_check(arguments.profile, findings,
                                    profile::parse_variables(arguments.variables),
                                    arguments.settings, text_file.empty() ? nullptr : &text);
  if (mission.peers.empty()) return checked;
  auto chosen = mission;
  std::erase_if(chosen.peers, [&](const profile::PeerProfile& peer) {
    return !launch::is_chosen(peer, arguments.only);
  });
  for (const auto& more : {launch::check_machine(mission, arguments.host),
                           launch::check_plugins(chosen, arguments.host)}) {
    findings.insert(findings.end(), more.begin(), more.end());
  }
  return checked;
}

std::vector<profile::Finding> findings_of(const CheckArguments& arguments) {
  auto [mission, findings] = check_mission(arguments, arguments.text);
  if (mission.peers.empty()) return findings;
  const bool nobody_here = std::ranges::none_of(
      mission.peers, [&](const auto& peer) { return launch::is_here(peer.host, arguments.host); });
  if (nobody_here) {
    findings.push_back({profile::Severity::Warning, mission.peers.front().where,
                        launch::nobody_here(mission, arguments.host), ""});
  }
  const auto of_hosts = launch::check_hosts(mission, arguments.host);
  findings.insert(findings.end(), of_hosts.begin(), of_hosts.end());
  return findings;
}

namespace {

void print_findings(const std::vector<profile::Finding>& findings) {
  auto list = nlohmann::ordered_json::array();
  for (const auto& finding : findings) {
    list.push_back({{"file", finding.where.file},
                    {"line", finding.where.line},
                    {"column", finding.where.column},
                    {"severity", to_string(finding.severity)},
                    {"problem", finding.problem},
                    {"remedy", finding.remedy}});
  }
  print_json(list, true);
}

}  // namespace

int check(const CheckArguments& arguments) {
  const auto findings = findings_of(arguments);
  const int result = profile::has_errors(findings) ? launch::kConfigurationError : 0;
  if (arguments.json) {
    print_findings(findings);
    return result;
  }
  std::fputs(profile::to_text(findings).c_str(), stderr);
  if (result == 0) {
    const auto notes =
        std::ranges::count(findings, profile::Severity::Note, &profile::Finding::severity);
    std::printf("%s: complete: every dependency is resolved%s\n",
                printable(arguments.profile, arguments.profile.size()).c_str(),
                notes > 0 ? "; see the notes" : "");
  }
  return result;
}

}  // namespace skein::command
