#include "point_mass.hpp"

#include <algorithm>
#include <cmath>

#include "angles.hpp"

namespace reconnaissance {
namespace {

// Below this airspeed the lift's direction means nothing, and divisions by it are of no use.
constexpr double kLeastFlown_m_s = 1;
// The nose-down path of a stalled aircraft.
constexpr double kStalledDive_rad = -0.2618;
constexpr double kFlyingAgain = 1.1;

double approach(double from, double to, double time_s, double seconds) {
  return from + (to - from) * (1 - std::exp(-seconds / time_s));
}

double within(double value, double limit) { return std::clamp(value, -limit, limit); }

double limited_step(double from, double to, double greatest_rate, double seconds) {
  return from + within(to - from, greatest_rate * seconds);
}

double drag_n(const Airframe& airframe, double mass, double airspeed, double load_factor) {
  const double pressure =
      0.5 * airframe.air_density_kg_m3 * airspeed * airspeed * airframe.wing_area_m2;
  const double lift =
      std::min(load_factor * mass * kGravity_m_s2 / pressure, airframe.greatest_lift);
  return pressure * (airframe.parasitic_drag + airframe.induced_drag * lift * lift);
}

/// The thrust that gives the demanded acceleration, as far as engine and fuel go.
double thrust_n(const Airframe& airframe, const Aircraft& aircraft, double wanted_n) {
  if (aircraft.fuel_kg <= 0 || aircraft.airspeed_m_s > airframe.never_exceed_m_s) return 0;
  const double available =
      std::min(airframe.greatest_thrust_n,
               airframe.greatest_power_w / std::max(aircraft.airspeed_m_s, kLeastFlown_m_s));
  return std::clamp(wanted_n, 0.0, available);
}

void burn(const Airframe& airframe, Aircraft& aircraft, double thrust, double seconds) {
  const double power_w = thrust * std::max(aircraft.airspeed_m_s, kLeastFlown_m_s);
  aircraft.fuel_kg =
      std::max(0.0, aircraft.fuel_kg - power_w * airframe.fuel_per_joule_kg * seconds);
}

/// How much the wind carries it along its heading.
double tailwind_m_s(const Aircraft& aircraft, const Wind& wind) {
  return wind.north_m_s * std::cos(aircraft.heading_rad) +
         wind.east_m_s * std::sin(aircraft.heading_rad);
}

/// The wheels turn into the direction of the motion.
void touch_down(Aircraft& aircraft, const Wind& wind) {
  const double speed = std::hypot(aircraft.north_m_s, aircraft.east_m_s);
  aircraft.heading_rad = course(std::atan2(aircraft.east_m_s, aircraft.north_m_s));
  aircraft.airspeed_m_s = speed - tailwind_m_s(aircraft, wind);
  aircraft.on_ground = true;
  aircraft.stalled = false;
  aircraft.climb_rad = 0;
  aircraft.bank_rad = 0;
  aircraft.up_m_s = 0;
}

void move(Aircraft& aircraft, const Wind& wind, double ground_m, double seconds) {
  double level = aircraft.airspeed_m_s * std::cos(aircraft.climb_rad);
  Wind felt = wind;
  if (aircraft.on_ground) {
    level = std::max(0.0, level + tailwind_m_s(aircraft, wind));
    felt = {};
  }
  aircraft.north_m_s = level * std::cos(aircraft.heading_rad) + felt.north_m_s;
  aircraft.east_m_s = level * std::sin(aircraft.heading_rad) + felt.east_m_s;
  aircraft.up_m_s = aircraft.airspeed_m_s * std::sin(aircraft.climb_rad) + felt.up_m_s;
  aircraft.position.north_m += aircraft.north_m_s * seconds;
  aircraft.position.east_m += aircraft.east_m_s * seconds;
  aircraft.position.height_m += aircraft.up_m_s * seconds;
  if (aircraft.position.height_m > ground_m) return;
  aircraft.position.height_m = ground_m;
  if (!aircraft.on_ground) touch_down(aircraft, wind);
}

/// Its motion over ground goes on, and makes that through the air: it drifts no sooner than it has
/// turned away.
void leave_ground(Aircraft& aircraft, const Wind& wind, double ground_m_s) {
  const double north = ground_m_s * std::cos(aircraft.heading_rad) - wind.north_m_s;
  const double east = ground_m_s * std::sin(aircraft.heading_rad) - wind.east_m_s;
  aircraft.heading_rad = course(std::atan2(east, north));
  aircraft.airspeed_m_s = std::hypot(north, east);
  aircraft.on_ground = false;
}

/// Whether it is fast enough, and told, to leave the ground.
bool lifts_off(const Airframe& airframe, const Aircraft& aircraft, const Demand& demand) {
  return demand.climb_rad > 0 &&
         aircraft.airspeed_m_s >=
             kFlyingAgain * stall_speed_m_s(airframe, mass_kg(airframe, aircraft), 0);
}

/// On its wheels, which the wind does not move: the speed over ground is what goes on.
void roll(const Airframe& airframe, Aircraft& aircraft, const Demand& demand, const Wind& wind,
          double seconds) {
  const double mass = mass_kg(airframe, aircraft);
  const double tailwind = tailwind_m_s(aircraft, wind);
  double ground = std::hypot(aircraft.north_m_s, aircraft.east_m_s);
  aircraft.airspeed_m_s = ground - tailwind;
  const double missing = demand.airspeed_m_s - aircraft.airspeed_m_s;
  if (demand.airspeed_m_s > 0 && missing > 0) {
    const double thrust = thrust_n(airframe, aircraft, mass * missing / airframe.speed_time_s);
    burn(airframe, aircraft, thrust, seconds);
    ground += thrust / mass * seconds;
  } else {
    const double wanted = demand.airspeed_m_s > 0 ? demand.airspeed_m_s + tailwind : 0;
    ground = std::max({0.0, wanted, ground - airframe.braking_m_s2 * seconds});
  }
  aircraft.airspeed_m_s = ground - tailwind;
  if (lifts_off(airframe, aircraft, demand)) leave_ground(aircraft, wind, ground);
}

double turn_rate_rad_s(const Aircraft& aircraft) {
  return kGravity_m_s2 * std::tan(aircraft.bank_rad) /
         std::max(aircraft.airspeed_m_s, kLeastFlown_m_s);
}

void fly(const Airframe& airframe, Aircraft& aircraft, const Demand& demand, double seconds) {
  const double mass = mass_kg(airframe, aircraft);
  const double stall = stall_speed_m_s(airframe, mass, aircraft.bank_rad);
  aircraft.stalled = aircraft.airspeed_m_s < stall ||
                     (aircraft.stalled && aircraft.airspeed_m_s < kFlyingAgain * stall);
  const double bank = aircraft.stalled ? 0 : demand.bank_rad;
  const double climb = aircraft.stalled ? kStalledDive_rad : demand.climb_rad;
  aircraft.bank_rad = limited_step(aircraft.bank_rad,
                                   approach(aircraft.bank_rad, bank, airframe.bank_time_s, seconds),
                                   airframe.greatest_bank_rate_rad_s, seconds);
  aircraft.climb_rad = approach(aircraft.climb_rad, climb, airframe.climb_time_s, seconds);
  const double load_factor = std::cos(aircraft.climb_rad) / std::cos(aircraft.bank_rad);
  const double drag =
      drag_n(airframe, mass, std::max(aircraft.airspeed_m_s, kLeastFlown_m_s), load_factor);
  const double along_path = mass * kGravity_m_s2 * std::sin(aircraft.climb_rad);
  const double faster =
      mass * (demand.airspeed_m_s - aircraft.airspeed_m_s) / airframe.speed_time_s;
  const double thrust = thrust_n(airframe, aircraft, drag + along_path + faster);
  burn(airframe, aircraft, thrust, seconds);
  aircraft.airspeed_m_s =
      std::max(0.0, aircraft.airspeed_m_s + (thrust - drag - along_path) / mass * seconds);
  aircraft.heading_rad = course(aircraft.heading_rad + turn_rate_rad_s(aircraft) * seconds);
}

Demand within_limits(const Airframe& airframe, const Demand& demand) {
  return {within(demand.bank_rad, airframe.greatest_bank_rad),
          within(demand.climb_rad, airframe.greatest_climb_rad),
          std::clamp(demand.airspeed_m_s, 0.0, airframe.never_exceed_m_s)};
}

}  // namespace

double mass_kg(const Airframe& airframe, const Aircraft& aircraft) {
  return airframe.empty_mass_kg + aircraft.fuel_kg;
}

double stall_speed_m_s(const Airframe& airframe, double mass_kg, double bank_rad) {
  return std::sqrt(2 * mass_kg * kGravity_m_s2 /
                   (airframe.air_density_kg_m3 * airframe.wing_area_m2 * airframe.greatest_lift *
                    std::cos(bank_rad)));
}

double turn_radius_m(double airspeed_m_s, double bank_rad) {
  return airspeed_m_s * airspeed_m_s / (kGravity_m_s2 * std::tan(bank_rad));
}

Aircraft advance(const Airframe& airframe, const Aircraft& aircraft, const Demand& demand,
                 const Wind& wind, double ground_m, double seconds) {
  Aircraft next = aircraft;
  const Demand wanted = within_limits(airframe, demand);
  if (next.on_ground) roll(airframe, next, wanted, wind, seconds);
  if (!next.on_ground) fly(airframe, next, wanted, seconds);
  move(next, wind, ground_m, seconds);
  return next;
}

Aircraft advance_kinematic(const Airframe& airframe, const Aircraft& aircraft, const Demand& demand,
                           const Wind& wind, double ground_m, double seconds) {
  Aircraft next = aircraft;
  const Demand wanted = within_limits(airframe, demand);
  if (next.on_ground) {
    roll(airframe, next, wanted, wind, seconds);
  } else {
    const double drag = drag_n(airframe, mass_kg(airframe, aircraft),
                               std::max(aircraft.airspeed_m_s, kLeastFlown_m_s), 1);
    burn(airframe, next, drag, seconds);
    next.airspeed_m_s =
        limited_step(next.airspeed_m_s, wanted.airspeed_m_s, airframe.braking_m_s2, seconds);
  }
  if (!next.on_ground) {
    next.bank_rad =
        limited_step(next.bank_rad, wanted.bank_rad, airframe.greatest_bank_rate_rad_s, seconds);
    next.climb_rad = limited_step(next.climb_rad, wanted.climb_rad,
                                  airframe.greatest_climb_rad / airframe.climb_time_s, seconds);
    next.heading_rad = course(next.heading_rad + turn_rate_rad_s(next) * seconds);
  }
  move(next, wind, ground_m, seconds);
  return next;
}

}  // namespace reconnaissance
