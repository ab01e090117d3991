#include "mission_plan.hpp"

#include <algorithm>
#include <array>
#include <chrono>
#include <cinttypes>
#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <vector>

#include "mission/check/profile_check.hpp"
#include "mission/profile/value_file.hpp"

namespace skein::command {
namespace {

std::string own_path() { return std::filesystem::read_symlink("/proc/self/exe").string(); }

void add_option(std::vector<std::string>& argv, const char* option,
                const std::vector<std::string>& values) {
  for (const std::string& value : values) argv.insert(argv.end(), {option, value});
}

std::vector<std::string> command_line(const MissionArguments& arguments,
                                      const profile::PeerProfile& peer,
                                      const profile::CspProfile* csp) {
  std::vector<std::string> argv{own_path(), "peer", arguments.profile,
                                csp ? peer.name + "/" + csp->name : peer.name};
  pass_on(argv, arguments);
  return argv;
}

// For the connection, beside what its processes take.
constexpr std::chrono::seconds kToConnect{15};
constexpr std::chrono::seconds kToSayFarewell{2};

launch::ChildPlan other_host(const launch::LaunchPlan& there, const PlanArguments& arguments,
                             bool verbose) {
  launch::ChildPlan child;
  child.name = arguments.host;
  child.argv = {own_path(), "attend", std::filesystem::absolute(arguments.profile).string(),
                "--host", arguments.host};
  pass_on_choice(child.argv, arguments);
  if (verbose) child.argv.emplace_back("--verbose");
  child.rules.on_loss = profile::LossPolicy::Continue;
  child.rules.ready_timeout = kToConnect;
  child.rules.stop_timeout = {};
  for (const launch::ChildPlan& process : there.children) {
    child.runs_mission |= process.runs_mission;
    child.rules.on_loss = std::min(child.rules.on_loss, process.rules.on_loss);
    child.rules.ready_timeout += process.rules.ready_timeout;
    child.rules.stop_timeout = std::max(child.rules.stop_timeout, process.rules.stop_timeout);
  }
  child.rules.stop_timeout += kToSayFarewell;
  return child;
}

/// FNV-1a, of 64 bits.
class Fingerprint {
 public:
  void add(const std::filesystem::path& file) {
    std::ifstream stream(file, std::ios::binary);
    for (std::istreambuf_iterator<char> at(stream), end; at != end; ++at) {
      value_ = (value_ ^ static_cast<unsigned char>(*at)) * 0x100000001b3;
    }
  }
  std::uint64_t value() const { return value_; }

 private:
  std::uint64_t value_ = 0xcbf29ce484222325;
};

}  // namespace

profile::MissionProfile read_mission(const MissionArguments& arguments) {
  return profile::read_checked_profile(
      arguments.profile, profile::parse_variables(arguments.variables), arguments.settings);
}

launch::LaunchPlan plan_of(const profile::MissionProfile& mission, const PlanArguments& arguments) {
  return launch::make_launch_plan(
      mission,
      [&](const profile::PeerProfile& peer, const profile::CspProfile* csp) {
        return command_line(arguments, peer, csp);
      },
      arguments.host, arguments.only);
}

void pass_on(std::vector<std::string>& argv, const MissionArguments& arguments) {
  add_option(argv, "--set", arguments.settings);
  add_option(argv, "--variable", arguments.variables);
}

void pass_on_choice(std::vector<std::string>& argv, const PlanArguments& arguments) {
  pass_on(argv, arguments);
  add_option(argv, "--only", arguments.only);
}

void add_other_hosts(launch::LaunchPlan& plan, const profile::MissionProfile& mission,
                     const LaunchArguments& arguments) {
  for (const std::string& host : launch::hosts_of(mission)) {
    if (launch::is_here(host, arguments.host)) continue;
    PlanArguments for_host = arguments;
    for_host.host = host;
    for (auto* assignments : {&for_host.settings, &for_host.variables})
      std::ranges::transform(*assignments, assignments->begin(),
                             profile::assignment_with_whole_path);
    const auto there = plan_of(mission, for_host);
    if (there.children.empty()) continue;
    plan.children.push_back(other_host(there, for_host, arguments.verbose));
    if (plan.children.back().runs_mission) plan.mission_elsewhere.clear();
    for (const launch::ChildPlan& process : there.children)
      std::erase(plan.elsewhere, process.name + " on " + host);
  }
}

std::string hello_of(const profile::MissionProfile& mission) {
  Fingerprint fingerprint;
  for (const auto& file : mission.files) fingerprint.add(file);
  std::array<char, 32> number{};
  std::snprintf(number.data(), number.size(), "%016" PRIx64, fingerprint.value());
  return std::string("version " SKEIN_VERSION ", profile ") + number.data();
}

}  // namespace skein::command
