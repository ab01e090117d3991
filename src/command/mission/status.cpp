#include <algorithm>
#include <array>
#include <cstdio>
#include <string>

#include "command/commands.hpp"
#include "command/print/json_output.hpp"
#include "core/printable.hpp"
#include "mission/check/profile_check.hpp"
#include "mission/process/exit_codes.hpp"
#include "mission/supervise/mission_claim.hpp"
#include "skein/detail/type_support.hpp"
#include "skein/mission_status.idl.hpp"

namespace skein::command {
namespace {

profile::MissionProfile mission_of(const RunningArguments& arguments) {
  // Its launcher has checked it, with the settings of its command line.
  return profile::read_mission_profile(arguments.profile,
                                       profile::parse_variables(arguments.variables));
}

/// The launcher knows peers by their own names; `skein peers` prints their system, too.
std::string without_system(const profile::MissionProfile& mission, const std::string& process) {
  const std::string first = process.substr(0, process.find('/'));
  const auto& peers = mission.peers;
  if (std::ranges::count(peers, first, &profile::PeerProfile::name) > 0 ||
      std::ranges::count(peers, first, &profile::PeerProfile::system) == 0)
    return process;
  return process.substr(std::min(process.size(), first.size() + 1));
}

constexpr std::size_t kLongestStateReason = 4096;

std::string seconds(double time) {
  std::array<char, 32> text{};
  std::snprintf(text.data(), text.size(), "%.1f s", time);
  return text.data();
}

void print_status(const launch::ProcessStatus& process) {
  std::string line = "  " + printable(process.name) + ": " + printable(process.state);
  if (process.pid != 0)
    line += ", process " + std::to_string(process.pid) + " for " + seconds(process.uptime);
  if (process.restarts > 0)
    line += ", restarted " +
            (process.restarts == 1 ? "once" : std::to_string(process.restarts) + " times");
  if (!process.last_exit.empty()) line += ", last ended " + printable(process.last_exit);
  if (!process.reason.empty()) line += "; " + printable(process.reason, process.reason.size());
  std::printf("%s\n", line.c_str());
}

void print_status(const launch::MissionStatus& status) {
  std::printf("mission %s, on domain %u, by launcher %u for %s%s\n",
              printable(status.mission).c_str(), status.domain, status.launcher,
              seconds(status.uptime).c_str(), status.degraded ? ", degraded" : "");
  if (!status.ending.empty())
    std::printf("  ends: %s\n", printable(status.ending, kLongestStateReason).c_str());
  for (const auto& process : status.processes) print_status(process);
  for (const auto& name : status.elsewhere)
    std::printf("  not started here: %s\n", printable(name).c_str());
}

int show_all(bool json) {
  auto list = nlohmann::ordered_json::array();
  std::size_t flown = 0;
  bool complete = true;
  for (const launch::LauncherAnswer& answer : launch::ask_launchers("status")) {
    if (!answer.failure.empty()) {
      complete = false;
      std::fprintf(stderr, "skein: %s\n", printable(answer.failure, kLongestStateReason).c_str());
      continue;
    }
    if (json) {
      list.push_back(nlohmann::ordered_json::parse(answer.text));
    } else {
      print_status(idl::from_json<launch::MissionStatus>(answer.text));
    }
    ++flown;
  }
  if (json) {
    print_json(list, true);
  } else if (flown == 0 && complete) {
    std::printf("no mission of this user flies here\n");
  }
  return complete ? 0 : launch::kStartFailed;
}

}  // namespace

int restart_process(const RestartArguments& arguments) {
  const auto mission = mission_of(arguments);
  const std::string answer = launch::ask_launcher(
      mission, arguments.host, "restart " + without_system(mission, arguments.process));
  std::printf("%s\n", printable(answer, answer.size()).c_str());
  return 0;
}

int show_status(const StatusArguments& arguments) {
  if (arguments.profile.empty()) return show_all(arguments.json);
  const std::string answer = launch::ask_launcher(mission_of(arguments), arguments.host, "status");
  if (arguments.json) {
    std::printf("%s\n", printable(answer, answer.size()).c_str());
  } else {
    print_status(idl::from_json<launch::MissionStatus>(answer));
  }
  return 0;
}

}  // namespace skein::command
