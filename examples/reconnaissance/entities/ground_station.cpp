#include "ground_station.hpp"

#include <fmt/chrono.h>
#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <utility>

#include "convert.hpp"
#include "mission/conduct.hpp"
#include "skein/error.hpp"
#include "stream.hpp"
#include "topics.hpp"

namespace reconnaissance {
namespace {

using namespace std::chrono_literals;

// Where there are several aircraft, it begins to wait when one is ready.
constexpr auto kPatience = 60s;
// Ticks of which a part is on its way; more have lost one.
constexpr std::size_t kOnTheWay = 100;
// Of the mission: until then everybody has to be fine.
constexpr double kLongestTest_s = 600;

PassConditions conditions_of(const skein::ParameterValues& values) {
  PassConditions conditions;
  if (const auto longest = values.find<std::chrono::duration<double>>("Longest flight"))
    conditions.longest_s = longest->count();
  const auto set = [&](double& condition, const char* name) {
    condition = values.find<double>(name).value_or(condition);
  };
  set(conditions.least_clearance_m, "Least clearance");
  set(conditions.least_survival, "Least survival");
  set(conditions.landed_within_m, "Landed within");
  set(conditions.least_fuel_kg, "Least fuel");
  return conditions;
}

Judge judge_of(const LocalFrame& frame, const recon::Runway& runway,
               const skein::ParameterValues& values) {
  return Judge(conditions_of(values),
               on_centre_line(strip(frame, runway), ApproachRules{}.aim_m, 0));
}

std::string track_line(Tick tick, std::uint32_t aircraft, const recon::Position& place,
                       double above_ground_m) {
  return fmt::format("{:.2f},{},{:.7f},{:.7f},{:.2f},{:.2f}\n", seconds_of(tick), aircraft,
                     place.latitude_deg, place.longitude_deg, place.height_m, above_ground_m);
}

}  // namespace

GroundStation::GroundStation(const InSystem& system, const skein::ParameterValues& values,
                             const RunwayText& own)
    : system_(system),
      order_{runway(own)},
      frame_(parse_runway(values.get<std::string>("Runway")).threshold),
      patience_(values.find<skein::Duration>("Patience").value_or(2min)),
      ground_(ground_of(values)),
      judge_(judge_of(frame_, order_.runway, values)),
      recorder_(system, frame_),
      scoring_(system, frame_, values) {
  const auto state = all_of_state();
  hear<recon::Truth>(topic::kTruth.name);
  hear<recon::MissionStatus>(topic::kStatus, state);
  hear<recon::MissionMode>(topic::kMode.name, state);
  hear<recon::ThreatPicture>(topic::kThreats.name, state);
  hear<recon::ElementList>(topic::kElements.name, state);
  hear<recon::ThreatTruth>(topic::kThreatTruth.name);
  hear<recon::Traffic>(topic::kTrafficTruth.name);
  hear<recon::ResolutionAdvisory>(topic::kAdvisory.name, state);
  hear<recon::FlightState>(topic::kFlightState.name, stream_qos());
  hear<skein::introspection::Decision>(topic::kDecisions, decisions_qos());
}

void GroundStation::begin() {
  simulator_ = system_.connect<recon::IFlightSimulator>(kPatience);
  // Before anybody can be due, and so before time begins: the mission is the same in each run.
  system_.connect<recon::IMissionManager>(kPatience).begin(order_, -1);
}

Verdict GroundStation::verdict(const std::string& ended) const {
  std::lock_guard lock(mutex_);
  return judge_.conclude(ended, scoring_.checks());
}

std::string GroundStation::tracks() const {
  std::lock_guard lock(mutex_);
  return tracks_;
}

Tick GroundStation::last_tick() const {
  std::lock_guard lock(mutex_);
  return last_tick_;
}

/// Minutes and seconds of the mission, and which aircraft where there are several.
std::string GroundStation::clock_of(Tick tick) const {
  return fmt::format("{:%M:%S}{}{}", std::chrono::floor<std::chrono::seconds>(time_of(tick)),
                     system_.name().empty() ? "" : "  ", system_.name());
}

std::string GroundStation::await_end(const std::stop_token& told_to_end) {
  std::unique_lock lock(mutex_);
  for (Tick seen = -1;;) {
    const auto is_over = [&] {
      return is_complete() || phase_ == recon::Phase::Aborted || judge_.too_long() ||
             never_begins();
    };
    const bool moved = changed_.wait_for(lock, told_to_end, patience_,
                                         [&] { return is_over() || last_tick_ != seen; });
    if (is_complete()) return "";
    if (told_to_end.stop_requested()) return "the ground station was told to end";
    if (phase_ == recon::Phase::Aborted) return "the mission was aborted: " + reason_;
    if (judge_.too_long()) return "the flight takes too long";
    if (never_begins())
      return fmt::format("there was no take-off within {:.0f} s: {}", kLongestTest_s, why_limited_);
    if (!moved) {
      lock.unlock();
      const std::string reason = why_time_stands();
      lock.lock();
      if (!reason.empty()) return reason;
    }
    seen = last_tick_;
  }
}

/// Empty where somebody has paused it.
std::string GroundStation::why_time_stands() {
  std::string reason = fmt::format("nothing of the aircraft was seen for {:.0f} s",
                                   std::chrono::duration<double>(patience_).count());
  try {
    const auto status = simulator_->status();
    if (status.paused) return "";
    for (const std::string& name : status.awaited) reason += "; time waits for " + name;
    if (status.tick < 0)
      reason += fmt::format(
          "; time has not begun, since {} take part in it: how many must is the parameter "
          "'Participants'",
          status.participants);
  } catch (const skein::Error& error) {
    reason += fmt::format("; the flight simulator: {}", error.what());
  }
  return reason;
}

/// Somebody is not fine, and does not become so.
bool GroundStation::never_begins() const {
  return phase_ == recon::Phase::BuiltInTest && seconds_of(last_tick_) > kLongestTest_s;
}

/// The mission manager has a moment to say so, too.
bool GroundStation::is_complete() const {
  constexpr Tick kMoment = 250;
  return judge_.standing() &&
         (phase_ == recon::Phase::Complete || last_tick_ > last_moving_tick_ + kMoment);
}

void GroundStation::see(const recon::Truth& truth) {
  {
    std::lock_guard lock(mutex_);
    moments_[truth.tick].own = truth;
    judge_what_is_whole();
  }
  changed_.notify_all();
}

void GroundStation::see(const recon::Traffic& traffic) {
  {
    std::lock_guard lock(mutex_);
    moments_[traffic.tick].others = traffic;
    judge_what_is_whole();
  }
  changed_.notify_all();
}

/// In the order of time, with all aircraft where they were at the same instant.
void GroundStation::judge_what_is_whole() {
  for (; !moments_.empty(); moments_.erase(moments_.begin())) {
    const auto& [own, others] = moments_.begin()->second;
    if (!own || !others) {
      if (moments_.size() <= kOnTheWay) return;
      continue;
    }
    tracks_ += track_line(own->tick, 0, own->position, own->height_above_ground_m);
    last_tick_ = own->tick;
    if (!judge_.standing()) last_moving_tick_ = own->tick;
    judge_.see({seconds_of(own->tick), local(frame_, own->position), own->height_above_ground_m,
                own->ground_speed_m_s, own->fuel_kg, own->on_ground, own->stalled});
    for (const recon::OtherAircraft& each : others->others) {
      const Local place = local(frame_, each.position);
      judge_.meet(place);
      tracks_ += track_line(own->tick, each.number, each.position,
                            place.height_m - ground_(place.north_m, place.east_m));
    }
  }
}

void GroundStation::see(const recon::MissionStatus& status) {
  {
    std::lock_guard lock(mutex_);
    if (phase_ == status.phase && reason_ == status.reason) return;
    if (status.phase == recon::Phase::Egress && phase_ != status.phase)
      judge_.flies_home(status.reason);
    phase_ = status.phase;
    reason_ = status.reason;
  }
  changed_.notify_all();
  fmt::print("{}  {}: {}\n", clock_of(status.tick), to_string(status.phase), status.reason);
  std::fflush(stdout);
}

void GroundStation::see(const recon::MissionMode& mode) {
  {
    std::lock_guard lock(mutex_);
    why_limited_ = mode.reason.empty() ? mode.cause : mode.reason;
    if (mode_ == mode.mode && flight_order_ == mode.flight) return;
    mode_ = mode.mode;
    flight_order_ = mode.flight;
  }
  fmt::print("{}  mode {}, {}{}{}\n", clock_of(mode.tick), to_string(mode.mode),
             to_string(mode.flight), mode.cause.empty() ? "" : ": " + mode.cause,
             mode.reason.empty() ? "" : "; " + mode.reason);
  std::fflush(stdout);
}

void GroundStation::see(const recon::ThreatPicture& picture) {
  for (const recon::Threat& threat : picture.threats) {
    {
      std::lock_guard lock(mutex_);
      if (!threats_.insert(threat.number).second) continue;
    }
    fmt::print("{}  threat {}: {} at {:.3f} {:.3f} within {:.0f} m\n", clock_of(picture.tick),
               threat.number, threat.kind, threat.position.latitude_deg,
               threat.position.longitude_deg, threat.deviation_m);
  }
  std::fflush(stdout);
}

void GroundStation::see(const recon::ThreatTruth& truth) {
  std::lock_guard lock(mutex_);
  if (!judge_.standing()) judge_.suffer(truth.survival, truth.tracked_s);
}

void GroundStation::see(const recon::ResolutionAdvisory& advisory) {
  std::lock_guard lock(mutex_);
  alert_ = advisory.alert;
}

void GroundStation::see(const recon::FlightState& state) {
  bool avoiding_changed = false, sets_changed = false;
  recon::TrafficAlert alert{};
  {
    std::lock_guard lock(mutex_);
    avoiding_changed = std::exchange(avoiding_, state.avoiding) != state.avoiding;
    sets_changed = std::exchange(sets_heard_, state.sets_heard) != state.sets_heard;
    alert = alert_;
  }
  if (avoiding_changed)
    fmt::print("{}  {}\n", clock_of(state.tick),
               state.avoiding ? fmt::format("another aircraft is avoided ({})", to_string(alert))
                              : "clear of other aircraft: back to the route");
  if (sets_changed)
    fmt::print("{}  {} of 3 sets of sensors are heard\n", clock_of(state.tick), state.sets_heard);
  std::fflush(stdout);
}

void GroundStation::see(const skein::introspection::Decision& decision) {
  using skein::introspection::Outcome;
  if (!system_.has(decision.entity)) return;
  std::string lost, instead;
  for (const auto& attempt : decision.attempts) {
    if (attempt.outcome == Outcome::Disconnected) lost = attempt.csp + " has died at its task";
    if (attempt.outcome == Outcome::TimedOut) lost = attempt.csp + " does not answer";
    if (attempt.outcome == Outcome::Accepted) instead = attempt.csp;
  }
  if (lost.empty()) return;
  std::lock_guard lock(mutex_);
  fmt::print("{}  {}: {}\n", clock_of(last_tick_), lost,
             instead.empty() ? "nobody does it instead" : instead + " does it instead");
  std::fflush(stdout);
}

void GroundStation::see(const recon::ElementList& list) {
  {
    std::lock_guard lock(mutex_);
    const auto collected = std::ranges::count_if(list.elements, &recon::Element::collected);
    const auto task =
        list.elements.empty() ? recon::ElementTask::TakeImages : list.elements.front().task;
    judge_.count(static_cast<std::size_t>(collected), list.elements.size(), how_collected(task));
  }
  for (const recon::Element& element : list.elements) {
    bool found = false, collected = false;
    {
      std::lock_guard lock(mutex_);
      found = element.found && found_.insert(element.name).second;
      collected = element.collected && collected_.insert(element.name).second;
    }
    if (found)
      fmt::print("{}  {} found at {:.4f} {:.4f} within {:.1f} m\n", clock_of(list.tick),
                 element.name, element.line.front().latitude_deg,
                 element.line.front().longitude_deg, element.deviation_m);
    if (collected)
      fmt::print("{}  {} {}\n", clock_of(list.tick), element.name, collected_text(element));
  }
  std::fflush(stdout);
}

}  // namespace reconnaissance
