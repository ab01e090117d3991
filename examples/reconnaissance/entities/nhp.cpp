#include "nhp.hpp"

#include <fmt/chrono.h>
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "convert.hpp"
#include "deciding.hpp"
#include "flight/aircraft_type.hpp"
#include "mission/places.hpp"
#include "skein/error.hpp"
#include "topics.hpp"

namespace reconnaissance {
namespace {

using namespace std::chrono_literals;

constexpr Tick kHealthPeriod = 50;
// The executive counts an entity as lost after a minute of silence, until it speaks again.
constexpr Tick kGivenUp = 60 * kHealthPeriod;
// What somebody has told in the tick before is on its way here.
constexpr auto kHeardWithin = 1s;
// Of the way home before it is planned, what turns and wind add.
constexpr double kTurnsAndWind = 1.33;

double fuel_kg_m(const AircraftType& type) {
  return type.fuel_kg_s / type.rules.cruise_m_s * kTurnsAndWind;
}

/// Throws where a name is not of the crew: nobody would hear of it.
std::vector<std::string> required_of(const skein::ParameterValues& values,
                                     const std::vector<std::string>& crew) {
  auto required = parse_names(values.find<std::string>("Required").value_or(""));
  for (const std::string& name : required) {
    if (std::ranges::count(crew, name) > 0) continue;
    throw skein::InvalidArgument(fmt::format(
        "parameter 'Required': '{}' is not of the crew, which is {}", name, fmt::join(crew, ", ")));
  }
  return required;
}

}  // namespace

Nhp::Nhp(skein::Entity& entity, const skein::ParameterValues& values)
    : entity_(entity),
      crew_(parse_names(values.get<std::string>("Crew"))),
      required_(required_of(values, crew_)),
      fuel_reserve_kg_(values.find<double>("Fuel reserve").value_or(20)),
      fuel_kg_m_(
          fuel_kg_m(aircraft_type(values.find<std::string>("Aircraft type").value_or("medium")))),
      flight_(entity, topic::kFlightState),
      healths_(entity.subscription<recon::Health>(
          topic::kHealth, skein::TopicQos::state(),
          [this](const recon::Health& health) { hear(health); }, {.executor = &hearing_})),
      mode_(entity.publisher<recon::MissionMode>(topic::kMode.name, skein::TopicQos::state())),
      member_(entity, values, [this](Tick tick) {
        if (is_due(topic::kMode.period, tick)) judge(tick);
      }) {}

void Nhp::hear(const recon::Health& health) {
  if (health.tick < judged_)
    health_[health.entity] = health;
  else
    early_.push_back(health);
}

/// By what everybody has told before this tick: so it is the same in each run.
void Nhp::judge(Tick tick) {
  judged_ = tick;
  for (const recon::Health& each : std::exchange(early_, {})) hear(each);
  recon::MissionMode mode;
  mode.tick = tick;
  mode.mode = recon::Mode::Starting;
  missing_.clear();
  if (tick > 0) {
    const Tick wanted = (tick - 1) / kHealthPeriod * kHealthPeriod;
    hearing_.run_until(std::chrono::steady_clock::now() + kHeardWithin,
                       [&] { return all_heard(wanted); });
    for (const std::string& name : crew_) {
      const std::string trouble = trouble_of(name, wanted);
      if (trouble.empty()) continue;
      mode.reason += (mode.reason.empty() ? "" : "; ") + name + " " + trouble;
      missing_.push_back({name, std::ranges::count(required_, name) > 0, given_up(name, tick)});
    }
    started_ = started_ || mode.reason.empty();
    if (started_) mode.mode = mode.reason.empty() ? recon::Mode::Normal : recon::Mode::Limited;
  }
  if (mode.mode != recon::Mode::Starting) order_flight(tick, mode);
  mode_.publish(mode);
}

void Nhp::order_flight(Tick tick, recon::MissionMode& mode) {
  const auto state = flight_.at(tick);
  if (!state) return;
  if (!home_) home_.emplace(geodetic(state->position));
  const Local place = local(*home_, state->position);
  recon::ExecutiveSituation situation;
  situation.fuel_kg = state->fuel_kg;
  situation.fuel_home_kg = fuel_kg_m_ * std::hypot(place.north_m, place.east_m);
  situation.fuel_for_mission_kg = situation.fuel_home_kg;
  situation.fuel_reserve_kg = fuel_reserve_kg_;
  situation.sensors = 3;
  situation.sensors_heard = state->sets_heard;
  situation.missing = missing_;
  const recon::ExecutiveDecision decision = ask_executives(situation);
  mode.flight = decision.order;
  mode.cause = decision.cause;
}

recon::ExecutiveDecision Nhp::ask_executives(const recon::ExecutiveSituation& situation) {
  skein::Task<recon::IExecutive, recon::ExecutiveDecision> task;
  task.request = "what the mission has to do";
  task.features = {{"missing", static_cast<double>(situation.missing.size())},
                   {"sensors", static_cast<double>(situation.sensors_heard)}};
  task.execution = skein::Execution::All;
  task.enough = skein::TaskOptions::kAll;
  task.run = [&](recon::IExecutive::Proxy& executive, skein::Duration) {
    return executive.async_decide(situation);
  };
  // The most severe: it costs the least of them to be wrong.
  task.synthesis = by_names(skein::best_by_cost<recon::ExecutiveDecision>(
      [](const auto& decision) { return -static_cast<double>(static_cast<int>(decision.order)); }));
  return decide(entity_, task).value_or(recon::ExecutiveDecision{});
}

bool Nhp::all_heard(Tick wanted) const {
  return std::ranges::all_of(crew_, [&](const std::string& name) {
    const auto found = health_.find(name);
    // Who was silent before is not waited for.
    return found == health_.end() || found->second.tick >= wanted ||
           found->second.tick < wanted - kHealthPeriod;
  });
}

bool Nhp::given_up(const std::string& name, Tick tick) const {
  const auto found = health_.find(name);
  return found != health_.end() && tick - found->second.tick > kGivenUp;
}

std::string Nhp::trouble_of(const std::string& name, Tick wanted) const {
  const auto found = health_.find(name);
  if (found == health_.end()) return "has not been heard of";
  const recon::Health& health = found->second;
  if (health.tick < wanted) {
    const auto last = std::chrono::floor<std::chrono::seconds>(time_of(health.tick));
    return fmt::format("has said nothing since {:%M:%S}", last);
  }
  switch (health.condition) {
    case recon::Condition::Fine:
      return "";
    case recon::Condition::Degraded:
      return "is degraded: " + health.reason;
    case recon::Condition::Failed:
      break;
  }
  return "has failed: " + health.reason;
}

}  // namespace reconnaissance
