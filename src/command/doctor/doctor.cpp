#include <algorithm>
#include <cstdio>

#include "command/mission/check.hpp"
#include "command/print/interruption.hpp"
#include "diagnosis.hpp"
#include "encounter.hpp"
#include "mission/check/profile_check.hpp"
#include "mission/profile/mission_profile.hpp"
#include "mission/supervise/launch_plan.hpp"
#include "mission/supervise/mission_claim.hpp"
#include "purpose.hpp"
#include "report.hpp"
#include "skein/detail/type_support.hpp"
#include "skein/error.hpp"
#include "skein/mission_status.idl.hpp"

namespace skein::command {
namespace {

using doctor::Severity;
using doctor::Symptoms;

/// What `skein check` finds, for a doctor's report.
Symptoms findings(const DoctorArguments& arguments) {
  CheckArguments of_check;
  of_check.profile = arguments.profile;
  of_check.host = arguments.host;
  of_check.variables = arguments.variables;
  Symptoms symptoms;
  for (const profile::Finding& finding : findings_of(of_check)) {
    const auto severity = finding.severity == profile::Severity::Error     ? Severity::Error
                          : finding.severity == profile::Severity::Warning ? Severity::Warning
                                                                           : Severity::Note;
    symptoms.push_back(
        {severity, "profile", finding.problem, profile::to_text(finding.where), finding.remedy});
  }
  if (symptoms.empty())
    symptoms.push_back({Severity::Fine, "profile", "`skein check` finds nothing", "", ""});
  return symptoms;
}

struct Read {
  std::optional<profile::MissionProfile> mission;  ///< What could be read of it.
  bool sound = false;                              ///< Whether the profile has no errors.
};

Read read_mission(const DoctorArguments& arguments) {
  if (arguments.profile.empty()) return {};
  std::vector<profile::Finding> findings;
  auto mission = profile::read_and_check(arguments.profile, findings,
                                         profile::parse_variables(arguments.variables));
  if (mission.peers.empty()) return {};
  return {std::move(mission), !profile::has_errors(findings)};
}

doctor::Purpose purpose_of(const DoctorArguments& arguments,
                           const std::optional<profile::MissionProfile>& mission) {
  doctor::Purpose purpose;
  if (mission) purpose = doctor::purpose_of(*mission, arguments.host);
  if (arguments.domain) {
    purpose.domain = *arguments.domain;
  } else if (arguments.profile.empty()) {
    purpose.domain = Onlooker().watched_domain();
  }
  if (!arguments.interface.empty()) purpose.interfaces = {arguments.interface};
  return purpose;
}

/// How the doctor joins: as the mission's peers do if the profile is sound.
Onlooker place_of(const DoctorArguments& arguments, const doctor::Purpose& purpose, bool sound) {
  Onlooker place;
  if (sound && !arguments.domain && arguments.interface.empty()) {
    place.profile = arguments.profile;
    place.host = arguments.host;
    place.variables = arguments.variables;
    return place;
  }
  place.domain = purpose.domain;
  place.interface = purpose.interfaces.empty() ? "" : purpose.interfaces.front();
  return place;
}

/// The launcher's answer; nothing if the mission does not fly here, or the launcher hangs.
std::optional<launch::MissionStatus> status_of(const profile::MissionProfile& mission,
                                               const std::string& host) {
  try {
    return idl::from_json<launch::MissionStatus>(launch::ask_launcher(mission, host, "status"));
  } catch (const Error&) {
    return std::nullopt;  // other findings tell
  }
}

/// Takes those out of the mission that its launcher was told to leave out, and says so.
Symptoms leave_out(profile::MissionProfile& mission, const launch::MissionStatus& status) {
  std::string names;
  std::erase_if(mission.peers, [&](const profile::PeerProfile& peer) {
    if (std::ranges::count(status.elsewhere, peer.name + launch::kLeftOut) == 0) return false;
    names += (names.empty() ? "" : ", ") + peer.name;
    return true;
  });
  if (names.empty()) return {};
  return {{Severity::Note, "peers",
           "not started here" + std::string(launch::kLeftOut) + ": " + names, "skein status", ""}};
}

std::vector<std::string> usable_vendors(const doctor::Facts& facts) {
  std::vector<std::string> names;
  for (const doctor::VendorModule& vendor : facts.vendors)
    if (vendor.failure.empty()) names.push_back(vendor.name);
  return names;
}

}  // namespace

int examine(const DoctorArguments& arguments) {
  const auto [mission, sound] = read_mission(arguments);
  const doctor::Purpose purpose = purpose_of(arguments, mission);
  const doctor::Facts facts = doctor::collect_facts();
  Symptoms symptoms = doctor::diagnose(purpose, facts);
  const auto add = [&](const Symptoms& more) {
    symptoms.insert(symptoms.end(), more.begin(), more.end());
  };
  if (!arguments.profile.empty()) add(findings(arguments));
  auto expected = mission;
  const auto status = expected ? status_of(*expected, arguments.host) : std::nullopt;
  if (status) add(leave_out(*expected, *status));
  const Interruption interruption;  // what went before is ended by any signal
  add(doctor::encounter(place_of(arguments, purpose, sound), usable_vendors(facts),
                        expected ? &*expected : nullptr, status.has_value(), interruption));
  if (arguments.json) {
    doctor::print_as_json(symptoms);
  } else {
    std::fputs(doctor::to_text(symptoms).c_str(), stdout);
  }
  const Severity worst = worst_of(symptoms);
  return worst == Severity::Error ? 2 : worst == Severity::Warning ? 1 : 0;
}

}  // namespace skein::command
