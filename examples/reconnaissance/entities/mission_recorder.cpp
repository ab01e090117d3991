#include "mission_recorder.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "convert.hpp"
#include "skein/introspection.idl.hpp"
#include "skein/selection.hpp"
#include "stream.hpp"
#include "topics.hpp"

namespace reconnaissance {
namespace {

constexpr double kEach_s = 1;  // A page needs no more.
// Who transmits by then does so from the beginning.
constexpr double kBeginning_s = 5;
constexpr double kAgain_s = 10;
constexpr double kAnswer_s = 60;  // What is done so soon after something is done because of it.

template <class Item, class Key, class Value>
Item* find(std::vector<Item>& items, Key key, const Value& value) {
  const auto found = std::ranges::find(items, value, key);
  return found == items.end() ? nullptr : &*found;
}

double seconds(std::int64_t nanoseconds) { return static_cast<double>(nanoseconds) * 1e-9; }

}  // namespace

Recorder::Recorder(const InSystem& system, const LocalFrame& frame)
    : system_(system), frame_(frame) {
  const auto state = all_of_state();
  hear<recon::Truth>(topic::kTruth.name);
  hear<recon::FlightState>(topic::kFlightState.name, stream_qos());
  hear<recon::MissionStatus>(topic::kStatus, state);
  hear<recon::RouteTaken>(topic::kRoute, state);
  hear<recon::MissionMode>(topic::kMode.name, state);
  hear<recon::ThreatPicture>(topic::kThreats.name, state);
  hear<recon::ElementList>(topic::kElements.name, state);
  hear<recon::Images>(topic::kImages.name);
  hear<recon::ObjectTruths>(topic::kObjects.name);
  hear<recon::ThreatTruth>(topic::kThreatTruth.name);
  hear<recon::Traffic>(topic::kTrafficTruth.name);
  hear<recon::ResolutionAdvisory>(topic::kAdvisory.name, state);
  hear<skein::introspection::Decision>(topic::kDecisions, decisions_qos());
}

MissionRecord Recorder::record() const {
  std::lock_guard lock(mutex_);
  MissionRecord record = record_;
  for (const auto& [name, seconds] : latencies_) record.latencies.push_back({name, seconds});
  for (Fault& each : record.faults) {
    if (each.kind != FaultKind::Site || each.until_s) continue;
    each.until_s = each.noticed_s;
    each.answer = "It bars no way.";
  }
  return record;
}

void Recorder::see(const recon::Truth& truth) {
  std::lock_guard lock(mutex_);
  now_s_ = seconds_of(truth.tick);
  if (truth.sets_failing > sets_failing_) failing_since_s_ = now_s_;
  sets_failing_ = truth.sets_failing;
  if (truth.models_lost > models_lost_) {
    record_.faults.push_back(
        {now_s_, now_s_,
         fmt::format("{} is lost, which flies the aircraft",
                     flown_by_.empty() ? "The flight model" : flown_by_),
         "flight_simulator", now_s_,
         fmt::format("{} flies on from the last state; the mission's time has waited for it.",
                     truth.flown_by == flown_by_ ? "Another one" : truth.flown_by),
         FaultKind::Csp});
  }
  models_lost_ = truth.models_lost;
  flown_by_ = truth.flown_by;
  if (!record_.track.empty() && now_s_ < record_.track.back().time_s + kEach_s) return;
  record_.track.push_back({now_s_, local(frame_, truth.position), truth.height_above_ground_m,
                           truth.airspeed_m_s, truth.ground_speed_m_s, truth.heading_rad,
                           truth.climb_rad, truth.bank_rad, truth.fuel_kg});
}

void Recorder::see(const recon::FlightState& state) {
  std::lock_guard lock(mutex_);
  record_.lost_samples = state.lost_samples;
  const double time_s = seconds_of(state.tick);
  for (; sets_heard_ > state.sets_heard; --sets_heard_)
    record_.faults.push_back({failing_since_s_,
                              {},
                              "A set of sensors fails",
                              "flight_controller",
                              time_s,
                              "The others outvote it, and it is not heard until it agrees.",
                              FaultKind::Sensors});
  for (; sets_heard_ < state.sets_heard; ++sets_heard_)
    if (Fault* fault = open(FaultKind::Sensors)) fault->until_s = time_s;
  Fault* encounter = open(FaultKind::Traffic);
  if (encounter && state.avoiding)
    encounter->answer = "It is kept clear of before the route is flown.";
}

/// The one of its kind that is not over.
Fault* Recorder::open(FaultKind kind) {
  const auto found = std::ranges::find_if(
      record_.faults, [&](const Fault& fault) { return fault.kind == kind && !fault.until_s; });
  return found == record_.faults.end() ? nullptr : &*found;
}

void Recorder::see(const recon::RouteTaken& taken) {
  std::lock_guard lock(mutex_);
  const double time_s = seconds_of(taken.tick);
  record_.routes.push_back({time_s, taken.route.planner, locals(frame_, taken.route.points)});
  Fault* site = open(FaultKind::Site);
  if (!site || time_s > site->noticed_s + kAnswer_s) return;
  site->until_s = time_s;
  site->answer = "Another way is flown.";
}

void Recorder::see(const recon::MissionStatus& status) {
  std::lock_guard lock(mutex_);
  const std::string name = to_string(status.phase);
  if (!record_.phases.empty() && record_.phases.back().name == name &&
      record_.phases.back().reason == status.reason)
    return;
  record_.phases.push_back({seconds_of(status.tick), name, status.reason});
}

void Recorder::see(const recon::MissionMode& mode) {
  std::lock_guard lock(mutex_);
  const std::string name = to_string(mode.mode);
  if (!record_.modes.empty() && record_.modes.back().name == name) return;
  record_.modes.push_back({seconds_of(mode.tick), name, mode.reason});
}

void Recorder::see(const recon::ThreatPicture& picture) {
  std::lock_guard lock(mutex_);
  for (const recon::Threat& threat : picture.threats) {
    KnownThreat* known = find(record_.threats, &KnownThreat::number, threat.number);
    if (!known) {
      known = &record_.threats.emplace_back();
      known->number = threat.number;
      known->from_s = seconds_of(picture.tick);
      note_site(threat, known->from_s);
    }
    known->kind = threat.kind;
    known->place = local(frame_, threat.position);
    known->deviation_m = threat.deviation_m;
    known->detection_range_m = threat.detection_range_m;
    known->lethal_range_m = threat.lethal_range_m;
  }
}

/// Of one that began to transmit in flight.
void Recorder::note_site(const recon::Threat& threat, double time_s) {
  const Local place = local(frame_, threat.position);
  const auto distance_m = [&](const Transmitter& each) {
    return map_distance_m(each.place, place);
  };
  const auto nearest = std::ranges::min_element(sites_, {}, distance_m);
  if (nearest == sites_.end() || !nearest->since_s || *nearest->since_s == 0) return;
  record_.faults.push_back({*nearest->since_s,
                            {},
                            "A " + threat.kind + " pops up",
                            "ad_manager",
                            time_s,
                            "",
                            FaultKind::Site});
  nearest->since_s = 0;
}

void Recorder::see(const recon::ElementList& list) {
  std::lock_guard lock(mutex_);
  for (const recon::Element& element : list.elements) {
    Target* target = find(record_.targets, &Target::name, element.name);
    if (!target) {
      target = &record_.targets.emplace_back();
      target->name = element.name;
    }
    target->line = locals(frame_, element.line);
    target->priority = element.priority;
    target->wanted_sample_m = element.wanted_ground_sample_m;
    target->achieved_sample_m = element.achieved_ground_sample_m;
    target->deviation_m = element.deviation_m;
    if (element.collected && !target->collected_s) target->collected_s = seconds_of(list.tick);
    target->wanted_s = element.wanted_s;
    target->followed_s = element.followed_s;
    target->wanted_deviation_m = element.wanted_deviation_m;
    if (element.found && element.wanted_s > 0)
      target->path.push_back({seconds_of(list.tick), target->line.front()});
  }
}

void Recorder::see(const recon::Images& images) {
  std::lock_guard lock(mutex_);
  const double time_s = seconds_of(images.tick);
  for (const recon::Image& image : images.images) {
    const bool soon =
        !record_.footprints.empty() && time_s < record_.footprints.back().time_s + kEach_s;
    if (!soon)
      record_.footprints.push_back(
          {time_s, image.element, locals(frame_, image.corners), image.ground_sample_m});
  }
}

/// The first one, where it is to be followed.
void Recorder::see(const recon::ObjectTruths& truths) {
  std::lock_guard lock(mutex_);
  const bool followed = std::ranges::any_of(
      record_.targets, [](const Target& target) { return target.wanted_s > 0; });
  if (!followed || truths.objects.empty()) return;
  if (record_.truths.empty()) record_.truths.push_back({"where the target truly was", {}});
  record_.truths.front().points.push_back(
      {seconds_of(truths.tick), local(frame_, truths.objects.front().position)});
}

void Recorder::see(const recon::ThreatTruth& truth) {
  std::lock_guard lock(mutex_);
  const bool placed = std::ranges::any_of(
      record_.targets, [](const Target& target) { return target.wanted_deviation_m > 0; });
  if (placed && record_.truths.empty())
    for (const recon::SiteTruth& each : truth.sites)
      record_.truths.push_back({"where the " + each.kind + " truly is",
                                {{seconds_of(truth.tick), local(frame_, each.position)}}});
  record_.tracked_s = truth.tracked_s;
  record_.survival = truth.survival;
  sites_.resize(truth.sites.size());
  for (std::size_t i = 0; i < sites_.size(); ++i) {
    sites_[i].place = local(frame_, truth.sites[i].position);
    if (!sites_[i].since_s && truth.sites[i].mode != recon::RadarMode::Off)
      sites_[i].since_s = seconds_of(truth.tick) < kBeginning_s ? 0 : seconds_of(truth.tick);
  }
}

void Recorder::see(const recon::Traffic& traffic) {
  std::lock_guard lock(mutex_);
  const double time_s = seconds_of(traffic.tick);
  for (const recon::OtherAircraft& each : traffic.others) {
    OtherTrack* other = find(record_.others, &OtherTrack::number, each.number);
    if (!other) other = &record_.others.emplace_back(OtherTrack{each.number, {}});
    if (other->points.empty() || time_s >= other->points.back().time_s + kEach_s)
      other->points.push_back({time_s, local(frame_, each.position)});
  }
}

void Recorder::see(const recon::ResolutionAdvisory& advisory) {
  std::lock_guard lock(mutex_);
  const double time_s = seconds_of(advisory.tick);
  if (advisory.alert > alert_)
    record_.flags.push_back(
        {time_s, advisory.alert == recon::TrafficAlert::Warning,
         fmt::format("alert about another aircraft: {}", to_string(advisory.alert))});
  alert_ = advisory.alert;
  Fault* encounter = open(FaultKind::Traffic);
  const bool over = alert_ == recon::TrafficAlert::NoAlert && !advisory.avoidance.turns &&
                    !advisory.avoidance.climbs;
  if (encounter && over) encounter->until_s = time_s;
  if (!encounter && !over && !record_.others.empty())
    record_.faults.push_back({record_.others.back().points.front().time_s,
                              {},
                              "Another aircraft comes near",
                              "collision_manager",
                              time_s,
                              "An alert is given; the route keeps clear of it.",
                              FaultKind::Traffic});
}

/// Heads that decide each second choose the same for the same reason most of the time: told is what
/// they choose otherwise than they did a while before.
void Recorder::see(const skein::introspection::Decision& decision) {
  if (!system_.has(decision.entity)) return;
  std::lock_guard lock(mutex_);
  const std::string entity = decision.entity.substr(decision.entity.rfind('/') + 1);
  DecisionTold told;
  told.time_s = now_s_;
  told.entity = entity;
  told.question = decision.request.empty() ? decision.service : decision.request;
  told.took_s = seconds(decision.took);
  for (const auto& attempt : decision.attempts) {
    using skein::introspection::Outcome;
    const double took_s = seconds(attempt.took);
    if (attempt.outcome != Outcome::Preselected && attempt.outcome != Outcome::Cancelled)
      latencies_[entity + ": " + attempt.csp].push_back(took_s);
    if (attempt.outcome == Outcome::Accepted || attempt.outcome == Outcome::Preselected)
      told.chosen += (told.chosen.empty() ? "" : ", ") + attempt.csp;
    const bool lost =
        attempt.outcome == Outcome::TimedOut || attempt.outcome == Outcome::Disconnected;
    told.late = told.late || lost;
    if (lost)
      record_.faults.push_back(
          {now_s_,
           {},
           fmt::format("{} {}", attempt.csp,
                       attempt.outcome == Outcome::TimedOut ? "does not answer in time"
                                                            : "dies at its task"),
           entity,
           now_s_ + took_s,
           "",
           FaultKind::Csp});
    told.answers.push_back(
        {attempt.csp, skein::in_words(attempt.outcome),
         attempt.text.empty() ? attempt.reason : attempt.reason + "; " + attempt.text, took_s});
  }
  told.reason = !decision.failure.empty()     ? decision.failure
                : !decision.synthesis.empty() ? decision.synthesis
                : told.answers.empty()        ? ""
                                              : told.answers.back().reason;
  for (Fault& fault : record_.faults) {
    if (fault.kind != FaultKind::Csp || fault.until_s || fault.noticed_by != entity) continue;
    if (told.chosen.empty()) continue;
    fault.until_s = now_s_ + told.took_s;
    fault.answer = told.chosen + " does it instead.";
  }
  // Where all are heard nothing is chosen but whether there is a result.
  const std::string choice =
      decision.execution == "all" && !told.chosen.empty() ? "all" : told.chosen;
  const auto [last, first] = last_told_.try_emplace(entity + ": " + told.question);
  const bool again = last->second.choice == choice || told.time_s < last->second.time_s + kAgain_s;
  if (!first && again && !told.late) return;
  last->second = {choice, told.time_s};
  record_.decisions.push_back(told);
}

}  // namespace reconnaissance
