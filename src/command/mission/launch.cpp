#include <algorithm>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <memory>
#include <optional>
#include <string>
#include <string_view>

#include "check.hpp"
#include "command/commands.hpp"
#include "mission/check/machine_check.hpp"
#include "mission/hosts/attended_run.hpp"
#include "mission/peer/peer.hpp"
#include "mission/process/address_space.hpp"
#include "mission/process/crash_report.hpp"
#include "mission/process/exit_codes.hpp"
#include "mission/process/ready.hpp"
#include "mission/supervise/environment_record.hpp"
#include "mission/supervise/mission_claim.hpp"
#include "mission/supervise/mission_log.hpp"
#include "mission/supervise/supervisor.hpp"
#include "mission_plan.hpp"
#include "missions_elsewhere.hpp"
#include "narrator.hpp"
#include "skein/error.hpp"

namespace skein::command {
namespace {

/// The mission's log, which may be none.
class Journal {
 public:
  Journal(std::optional<launch::MissionLog> log, std::shared_ptr<Narrator> narrator)
      : log_(std::move(log)), narrator_(std::move(narrator)) {}

  void add_line(std::string_view process, std::string_view line) {
    if (log_ && !log_->add_line(process, line)) complain();
  }
  void add_event(const launch::ChildEvent& event) {
    if (log_ && !log_->add_event(event)) complain();
  }
  void add_event(std::string_view text) {
    if (log_ && !log_->add_event(text)) complain();
  }
  /// `; the logs are in FOLDER`.
  std::string place() const { return log_ ? "; the logs are in " + log_->folder().string() : ""; }

 private:
  void complain() const { narrator_->tell_error("* mission: the log " + log_->failure()); }

  std::optional<launch::MissionLog> log_;
  std::shared_ptr<Narrator> narrator_;
};

/// A folder that somebody named must be there; the default one need not.
std::optional<launch::MissionLog> make_log(const LaunchArguments& arguments,
                                           const profile::MissionProfile& mission,
                                           Narrator& narrator) {
  const launch::RotatingFile::Limits limits{arguments.log_size << 20, arguments.log_files};
  const std::string named = arguments.log_folder.empty() ? mission.logs : arguments.log_folder;
  if (arguments.no_log) return std::nullopt;
  if (!named.empty()) return std::optional<launch::MissionLog>(std::in_place, named, limits);
  const auto usual = launch::log_folder(mission);
  try {
    if (!usual.empty()) return std::optional<launch::MissionLog>(std::in_place, usual, limits);
  } catch (const Unavailable& error) {
    narrator.tell_error(std::string("* mission: keeps no logs: ") + error.what());
  }
  return std::nullopt;
}

launch::SupervisorOptions told_by(const std::shared_ptr<Narrator>& narrator,
                                  const std::shared_ptr<Journal>& journal) {
  launch::SupervisorOptions options;
  options.on_output = [narrator, journal](std::string_view child, std::string_view text) {
    const std::string line = launch::with_readable_symbols(text);
    journal->add_line(child, line);
    narrator->tell_line(child, line);
  };
  options.on_event = [narrator, journal](const launch::ChildEvent& event) {
    journal->add_event(event);
    narrator->tell(event);
  };
  return options;
}

/// Where it flies, and where commands look that are not told.
std::string mission_place(const profile::MissionProfile& mission) {
  const std::string domain = std::to_string(mission.domain);
  const char* const variable = std::getenv(kDomainVariable);
  const std::string named = variable ? variable : "";
  std::string text = "flies on domain " + domain;
  if (named == domain || (named.empty() && mission.domain == 0)) return text;
  return text + "; commands that look need --domain " + domain + ", or they look on domain " +
         (named.empty() ? "0" : named + ", as " + kDomainVariable + " says");
}

/// Throws DescriptionError with all that `check` finds, where one of it is an error; otherwise says
/// what it finds, and throws Unavailable where this machine may yet become ready. A dry run starts
/// nothing, and does not need what this machine may lack.
profile::MissionProfile read_checked(const LaunchArguments& arguments) {
  if (arguments.dry_run) return read_mission(arguments);
  auto [mission, findings] = check_mission(arguments);
  const auto is_lasting = [](const profile::Finding& finding) {
    return finding.severity == profile::Severity::Error && !finding.passing;
  };
  if (std::ranges::any_of(findings, is_lasting)) throw profile::DescriptionError(findings);
  std::fputs(profile::to_text(findings).c_str(), stderr);
  if (profile::has_errors(findings))
    throw Unavailable("this machine lacks for the moment what the mission needs; launch it later");
  return std::move(mission);
}

/// Last of all, where it is read.
void tell_failure(Narrator& narrator, const launch::LaunchResult& result,
                  const std::string& place) {
  narrator.tell_error("skein: " + result.reason);
  if (!result.first_fault.empty())
    narrator.tell_error("skein: the first fault was, " + result.first_fault);
  if (!place.empty())
    narrator.tell_error("skein: exit code " + std::to_string(result.exit_code) + place);
}

/// The exit code, after all was told.
int with_output_checked(Narrator& narrator, int code) {
  const std::string loss = narrator.finish();
  if (loss.empty()) return code;
  narrator.tell_error("skein: the output could not be written: " + loss);
  return code == 0 ? launch::kOutputLost : code;
}

/// For the launcher on another host, which keeps the logs.
int run_for_another(const launch::LaunchPlan& plan, launch::MissionClaim& claim,
                    const profile::MissionProfile& mission) {
  launch::SupervisorOptions options;
  options.requests = &claim.requests();
  return launch::run_attended(plan, std::move(options), hello_of(mission));
}

}  // namespace

int launch(const LaunchArguments& arguments) {
  const profile::MissionProfile mission = read_checked(arguments);
  auto plan = plan_of(mission, arguments);
  if (arguments.ssh) add_other_hosts(plan, mission, arguments);
  if (arguments.dry_run) {
    std::fputs(launch::to_text(plan).c_str(), stdout);
    return 0;
  }
  if (plan.children.empty()) throw InvalidArgument(launch::nobody_here(mission, arguments.host));
  launch::demand_address_space();
  const std::string beside = missions_beside(static_cast<std::uint32_t>(mission.domain));
  launch::MissionClaim claim(mission, arguments.host);
  // Who reads what it says may go; the mission goes on. Its processes get the default back.
  std::signal(SIGPIPE, SIG_IGN);
  if (arguments.attended) return run_for_another(plan, claim, mission);
  const auto narrator = std::make_shared<Narrator>(plan, arguments.verbose);
  narrator->tell_error("* mission: " + mission_place(mission));
  if (!beside.empty()) narrator->tell_error("* mission: " + beside);
  for (const std::string& name : plan.elsewhere)
    narrator->tell_error("* mission: not started here: " + name);
  const auto journal = std::make_shared<Journal>(make_log(arguments, mission, *narrator), narrator);
  for (const std::string& fact : launch::environment_record(mission, SKEIN_VERSION))
    journal->add_event(fact);
  auto options = told_by(narrator, journal);
  options.requests = &claim.requests();
  launch::Supervisor supervisor(plan, std::move(options));
  const launch::LaunchResult outcome = supervisor.run();
  journal->add_event("exit code: " + std::to_string(outcome.exit_code) +
                     (outcome.first_fault.empty() ? "" : "; first fault: " + outcome.first_fault));
  if (outcome.exit_code != 0) tell_failure(*narrator, outcome, journal->place());
  return with_output_checked(*narrator, outcome.exit_code);
}

int run_peer(const PeerArguments& arguments) {
  try {
    ComponentRegistry registry(arguments.words);
    return launch::run_process(read_mission(arguments), arguments.process, registry);
  } catch (const std::exception& error) {
    launch::report_waiting(error.what());
    throw;
  }
}

}  // namespace skein::command
