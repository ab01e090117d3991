#include <cstdio>
#include <filesystem>
#include <memory>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "commands.hpp"
#include "core/printable.hpp"
#include "launch/address_space.hpp"
#include "launch/machine_check.hpp"
#include "launch/mission_claim.hpp"
#include "launch/peer.hpp"
#include "launch/supervisor.hpp"
#include "profile/check.hpp"
#include "skein/error.hpp"

namespace skein::command {
namespace {

profile::MissionProfile read(const MissionArguments& arguments) {
  auto mission = profile::read_checked_profile(arguments.profile);
  for (const std::string& setting : arguments.settings) profile::apply_setting(mission, setting);
  return mission;
}

std::vector<std::string> command_line(const MissionArguments& arguments,
                                      const profile::PeerProfile& peer,
                                      const profile::CspProfile* csp) {
  std::vector<std::string> argv{std::filesystem::read_symlink("/proc/self/exe").string(), "peer",
                                arguments.profile, csp ? peer.name + "/" + csp->name : peer.name};
  for (const std::string& setting : arguments.settings) {
    argv.push_back("--set");
    argv.push_back(setting);
  }
  return argv;
}

void write(std::FILE* stream, const std::string& line) {
  std::fwrite(line.data(), 1, line.size(), stream);
  std::fflush(stream);
}

/// Lines and events as people want to read them: the mission's own text as it is, other peers'
/// lines with their names, and of the events those that are out of order.
class Narrator {
 public:
  Narrator(const launch::LaunchPlan& plan, bool verbose) : verbose_(verbose) {
    for (const launch::ChildPlan& child : plan.children) {
      if (child.runs_mission) mission_ = child.name;
    }
  }

  void tell_line(std::string_view child, std::string_view line) const {
    std::string text = child == mission_ ? "" : std::string(child) + " | ";
    write(stdout, text.append(printable(line, line.size())) + "\n");
  }

  void tell(const launch::ChildEvent& event) {
    if (event.state == launch::ChildState::Waiting) restarted_.insert(event.child);
    if (verbose_ || !in_order(event)) {
      write(stderr,
            "* " + (event.child.empty() ? "mission" : event.child) + ": " + event.text + "\n");
    }
  }

 private:
  bool in_order(const launch::ChildEvent& event) const {
    using launch::ChildState;
    // Without the mission's own text nothing else would tell that it flies.
    if (event.child.empty()) return !mission_.empty();
    switch (event.state) {
      case ChildState::Starting:
      case ChildState::Ready:
        return !restarted_.contains(event.child);
      case ChildState::Ended:
      case ChildState::Terminated:
        return true;
      default:
        return false;
    }
  }

  const bool verbose_;
  std::string mission_;
  std::set<std::string> restarted_;
};

launch::SupervisorOptions told_by(const std::shared_ptr<Narrator>& narrator) {
  launch::SupervisorOptions options;
  options.on_output = [narrator](std::string_view child, std::string_view line) {
    narrator->tell_line(child, line);
  };
  options.on_event = [narrator](const launch::ChildEvent& event) { narrator->tell(event); };
  return options;
}

}  // namespace

int launch(const LaunchArguments& arguments) {
  const profile::MissionProfile mission = read(arguments);
  const auto plan = launch::make_launch_plan(
      mission,
      [&](const profile::PeerProfile& peer, const profile::CspProfile* csp) {
        return command_line(arguments, peer, csp);
      },
      arguments.host);
  if (arguments.dry_run) {
    std::fputs(launch::to_text(plan).c_str(), stdout);
    return 0;
  }
  if (plan.children.empty()) throw InvalidArgument(launch::nobody_here(mission, arguments.host));
  const auto findings = launch::check_machine(mission, arguments.host);
  if (profile::has_errors(findings)) throw profile::DescriptionError(findings);
  launch::demand_address_space();
  const launch::MissionClaim claim(mission, arguments.host);
  for (const std::string& name : plan.elsewhere)
    write(stderr, "* mission: " + name + " is not started here\n");
  const auto narrator = std::make_shared<Narrator>(plan, arguments.verbose);
  launch::Supervisor supervisor(plan, told_by(narrator));
  const launch::LaunchResult outcome = supervisor.run();
  if (outcome.exit_code != 0) write(stderr, "skein: " + outcome.reason + "\n");
  return outcome.exit_code;
}

int run_peer(const PeerArguments& arguments) {
  ComponentRegistry registry;
  return launch::run_process(read(arguments), arguments.process, registry);
}

}  // namespace skein::command
