#include "flight_controller.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "convert.hpp"
#include "flight/angles.hpp"
#include "skein/head.hpp"
#include "topics.hpp"

namespace reconnaissance {
namespace {

// Of winds in which turns that were planned are flown as tightly as that.
constexpr double kTailWind_m_s = 7;

FlightRules rules_of(const AircraftType& type, const skein::ParameterValues& values) {
  FlightRules rules = type.rules;
  rules.cruise_m_s = values.find<double>("Cruising speed").value_or(rules.cruise_m_s);
  if (const auto bank = values.find<double>("Bank angle")) rules.greatest_bank_rad = radians(*bank);
  if (const auto climb = values.find<double>("Climb angle"))
    rules.greatest_climb_rad = radians(*climb);
  return rules;
}

recon::FlightMode told_mode(Pilot::Mode mode) {
  switch (mode) {
    case Pilot::Mode::Parked:
      return recon::FlightMode::Parked;
    case Pilot::Mode::TakingOff:
      return recon::FlightMode::TakingOff;
    case Pilot::Mode::Following:
      return recon::FlightMode::Following;
    case Pilot::Mode::Waiting:
      return recon::FlightMode::Waiting;
    case Pilot::Mode::Approaching:
      return recon::FlightMode::Approaching;
    case Pilot::Mode::Rolling:
      return recon::FlightMode::Rolling;
    case Pilot::Mode::Landed:
      break;
  }
  return recon::FlightMode::Landed;
}

}  // namespace

FlightController::FlightController(skein::Entity& entity, const skein::ParameterValues& values)
    : entity_(entity),
      type_(aircraft_type(values.find<std::string>("Aircraft type").value_or("medium"))),
      rules_(rules_of(type_, values)),
      pilot_(rules_, {[this](const Motion& motion, const Line& leg) {
                        return ask_guidance(motion, leg, 0);
                      },
                      [this](const Motion& motion, const Circle& circle) {
                        return ask_guidance(motion, {circle.centre, circle.centre},
                                            circle.clockwise ? circle.radius_m : -circle.radius_m);
                      }}),
      sensors_(entity, topic::kSensors),
      advisories_(entity, topic::kAdvisory, skein::TopicQos::state()),
      command_(entity.publisher<recon::FlightCommand>(topic::kFlightCommand.name, stream_qos())),
      state_(entity.publisher<recon::FlightState>(topic::kFlightState.name, stream_qos())),
      member_(entity, values, [this](Tick tick) { fly(tick); }) {}

void FlightController::start() {
  guidance_ = entity_.head().preselect<recon::IGuidance>();
  member_.start();
}

recon::FlightLimits FlightController::limits() {
  return {rules_.cruise_m_s, rules_.greatest_bank_rad, rules_.greatest_climb_rad,
          turn_radius_m(rules_.cruise_m_s + kTailWind_m_s, rules_.greatest_bank_rad),
          type_.fuel_kg_s};
}

void FlightController::take_off(const recon::Runway& from, std::int64_t tick) {
  accept(tick, 0, [this, from] {
    if (!frame_) frame_.emplace(geodetic(from.threshold));
    return pilot_.take_off(strip(*frame_, from));
  });
}

void FlightController::follow(const recon::Route& route, std::int64_t tick) {
  accept(tick, route.number, [this, route] {
    if (!frame_) return std::string("the aircraft is on the ground");
    return pilot_.follow(locals(*frame_, route.points));
  });
}

void FlightController::loiter(const recon::Position& about, double radius_m, std::int64_t tick) {
  accept(tick, 0, [this, about, radius_m] {
    if (!frame_) return std::string("the aircraft is on the ground");
    return pilot_.loiter({local(*frame_, about), std::abs(radius_m), radius_m > 0});
  });
}

void FlightController::land(const recon::Route& route, const recon::Runway& to, std::int64_t tick) {
  accept(tick, route.number, [this, route, to] {
    if (!frame_) return std::string("the aircraft is on the ground");
    return pilot_.land(locals(*frame_, route.points), strip(*frame_, to));
  });
}

void FlightController::accept(std::int64_t tick, std::uint32_t route,
                              std::function<std::string()> obey) {
  std::lock_guard lock(mutex_);
  std::erase_if(orders_, [&](const Order& order) { return order.from == tick + 1; });
  orders_.push_back({tick + 1, std::move(obey), route});
}

void FlightController::obey(Tick tick) {
  std::vector<Order> due;
  {
    std::lock_guard lock(mutex_);
    const auto later = std::stable_partition(
        orders_.begin(), orders_.end(), [&](const Order& order) { return order.from <= tick; });
    due.assign(std::make_move_iterator(orders_.begin()), std::make_move_iterator(later));
    orders_.erase(orders_.begin(), later);
  }
  for (const Order& order : due) {
    const std::string refusal = order.obey();
    if (refusal.empty()) {
      route_ = order.route;
      member_.health().set(recon::Condition::Fine);
    } else {
      member_.health().set(recon::Condition::Degraded, "an order was refused: " + refusal);
    }
  }
}

void FlightController::fly(Tick tick) {
  obey(tick);
  const auto sensors = sensors_.at(tick);
  if (!sensors) return;
  const auto sight = look(*sensors);
  if (sight) last_sight_ = sight;
  if (!last_sight_) return;
  const Demand demand = sight ? avoid(tick, pilot_.fly(*sight)) : fly_blind(*sensors);
  publish(tick, demand, *last_sight_, *sensors);
}

/// Level and straight on, until a set of sensors measures again. What looks downwards is none of
/// these sets.
Demand FlightController::fly_blind(const recon::Sensors& sensors) const {
  if (sensors.on_ground) return {};
  const Pilot::Sight below{last_sight_->measured, sensors.radar_height_m, false};
  return above_ground(rules_, {0, 0, rules_.cruise_m_s}, below, kLowBeside_m);
}

/// An advisory goes before the route, but not before a take-off or the straight part that leads
/// down to the runway.
Demand FlightController::avoid(Tick tick, const Demand& demand) {
  // Of a tick before: who advises waits for the state of this one.
  const auto advisory = advisories_.at(tick - 1);
  const bool free = pilot_.mode() == Pilot::Mode::Following ||
                    pilot_.mode() == Pilot::Mode::Waiting ||
                    (pilot_.mode() == Pilot::Mode::Approaching && pilot_.leg() + 2 < pilot_.legs());
  // Who advised last may be gone.
  const bool fresh = advisory && advisory->tick >= tick - 2 * topic::kAdvisory.period;
  avoiding_ = free && fresh && (advisory->avoidance.turns || advisory->avoidance.climbs);
  if (!avoiding_) return demand;
  const recon::Avoidance& wanted = advisory->avoidance;
  return advised(rules_, demand, *last_sight_,
                 wanted.turns ? std::optional(wanted.course_rad) : std::nullopt,
                 wanted.climbs ? std::optional(wanted.climb_m_s) : std::nullopt);
}

std::optional<Pilot::Sight> FlightController::look(const recon::Sensors& sensors) {
  std::array<std::optional<Measurement>, 3> sets;
  for (std::size_t i = 0; i < sets.size(); ++i) {
    const recon::SensorSet& set = sensors.sets[i];
    if (!set.working) continue;
    // Before the first runway is known the aircraft stands, and any place near it will do.
    if (!frame_ && !stand_) stand_.emplace(geodetic(set.position));
    sets[i] = Measurement{local(frame(), set.position),
                          set.north_m_s,
                          set.east_m_s,
                          set.up_m_s,
                          set.airspeed_m_s,
                          set.heading_rad,
                          set.climb_rad,
                          set.bank_rad};
  }
  const auto measured = voter_.vote(sets, kTick_s);
  if (!measured) return std::nullopt;
  return Pilot::Sight{*measured, sensors.radar_height_m, sensors.on_ground};
}

double FlightController::ask_guidance(const Motion& motion, const Line& leg,
                                      double circle_radius_m) {
  return guidance_->bank_rad({motion.north_m, motion.east_m, motion.north_m_s, motion.east_m_s,
                              leg.from.north_m, leg.from.east_m, leg.to.north_m, leg.to.east_m,
                              circle_radius_m});
}

void FlightController::publish(Tick tick, const Demand& demand, const Pilot::Sight& sight,
                               const recon::Sensors& sensors) {
  command_.publish({tick, demand.bank_rad, demand.climb_rad, demand.airspeed_m_s});
  if (!is_due(topic::kFlightState.period, tick)) return;
  const Measurement& measured = sight.measured;
  recon::FlightState state;
  state.tick = tick;
  state.mode = told_mode(pilot_.mode());
  state.position = position(frame(), measured.position);
  state.north_m_s = measured.north_m_s;
  state.east_m_s = measured.east_m_s;
  state.up_m_s = measured.up_m_s;
  state.airspeed_m_s = measured.airspeed_m_s;
  state.heading_rad = measured.heading_rad;
  state.bank_rad = measured.bank_rad;
  state.fuel_kg = sensors.fuel_kg;
  state.route = route_;
  state.leg = static_cast<std::uint32_t>(pilot_.leg());
  state.legs = static_cast<std::uint32_t>(pilot_.legs());
  state.route_course_rad = pilot_.route_course_rad(measured.position);
  state.avoiding = avoiding_;
  for (std::size_t i = 0; i < 3; ++i) state.sets_heard += voter_.out(i) ? 0 : 1;
  state.lost_samples = static_cast<std::uint32_t>(sensors_.lost());
  state_.publish(state);
}

}  // namespace reconnaissance
