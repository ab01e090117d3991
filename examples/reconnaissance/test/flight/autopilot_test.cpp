// What an autopilot makes of demands, and what the aircraft can do that it is made for.
#include "flight/autopilot.hpp"

#include <catch2/catch.hpp>

#include "flight/aircraft_type.hpp"
#include "flight/angles.hpp"
#include "skein/error.hpp"

namespace autopilot_test {

using namespace reconnaissance;

namespace {

constexpr double kStep_s = 0.02;

const AircraftType& tactical() { return aircraft_type("tactical"); }

Motions level() {
  Motions motions;
  motions.airspeed_m_s = motions.ground_m_s = 35;
  motions.on_ground = false;
  return motions;
}

Motions rolling(double speed_m_s) {
  Motions motions;
  motions.airspeed_m_s = motions.ground_m_s = speed_m_s;
  return motions;
}

Controls at_once(const Demand& demand, const Motions& motions) {
  return Autopilot{}.fly(tactical().airframe, demand, motions, kStep_s);
}

}  // namespace

TEST_CASE("an autopilot rolls towards the bank that is demanded, and brakes the roll") {
  CHECK(at_once({0.3, 0, 35}, level()).aileron > 0.1);
  CHECK(at_once({-0.3, 0, 35}, level()).aileron < -0.1);
  Motions there = level();
  there.bank_rad = 0.3;
  there.roll_rate = 0.5;
  CHECK(at_once({0.3, 0, 35}, there).aileron < -0.1);
}

TEST_CASE("an autopilot raises the nose to climb, and in a turn") {
  const double trimmed = at_once({0, 0, 35}, level()).elevator;
  CHECK(at_once({0, 0.1, 35}, level()).elevator > trimmed);
  CHECK(at_once({0, -0.1, 35}, level()).elevator < trimmed);
  Motions turning = level();
  turning.bank_rad = -0.4;
  CHECK(at_once({-0.4, 0, 35}, turning).elevator > trimmed);
}

TEST_CASE("an autopilot gives more throttle to be faster, and to climb; none leaves it idling") {
  const double trimmed = at_once({0, 0, 35}, level()).throttle;
  CHECK(at_once({0, 0, 36}, level()).throttle > trimmed);
  CHECK(at_once({0, 0.05, 35}, level()).throttle > trimmed);
  const double idle = at_once({0, -0.1, 0}, level()).throttle;
  CHECK(idle > 0);
  CHECK(idle < 0.2);
}

TEST_CASE("surfaces move more where the air is slower, and never further than they can") {
  Motions slow = level();
  slow.airspeed_m_s = 22;
  CHECK(at_once({0.1, 0, 22}, slow).aileron > at_once({0.1, 0, 35}, level()).aileron);
  slow.roll_rate = -20;
  CHECK(at_once({0.1, 0, 22}, slow).aileron == 1);
}

TEST_CASE("a demand beyond what the airframe can is cut to that") {
  const Airframe& airframe = tactical().airframe;
  CHECK(at_once({2, 0, 35}, level()).aileron ==
        at_once({airframe.greatest_bank_rad, 0, 35}, level()).aileron);
  CHECK(at_once({0, 1, 35}, level()).elevator ==
        at_once({0, airframe.greatest_climb_rad, 35}, level()).elevator);
}

TEST_CASE("an aircraft that is too slow gives up its climb") {
  Motions slow = level(), too_slow = level();
  slow.airspeed_m_s = 20;
  too_slow.airspeed_m_s = 19;
  // As if no climb were demanded, but for the gain of the surface.
  CHECK(at_once({0, 0.03, 20}, too_slow).elevator ==
        Approx(at_once({0, 0, 20}, slow).elevator * 20 * 20 / 19 / 19));
}

TEST_CASE("what stays wrong is learned") {
  Autopilot autopilot;
  Motions hanging = level();
  hanging.bank_rad = -0.02;
  const double first = autopilot.fly(tactical().airframe, {0, 0, 35}, hanging, kStep_s).aileron;
  double later = 0;
  for (int i = 0; i < 250; ++i)
    later = autopilot.fly(tactical().airframe, {0, 0, 35}, hanging, kStep_s).aileron;
  CHECK(later > first);
  autopilot.begin();
  CHECK(autopilot.fly(tactical().airframe, {0, 0, 35}, hanging, kStep_s).aileron == first);
}

TEST_CASE("on the ground it steers back to the course on which it began to roll") {
  Autopilot autopilot;
  Motions motions = rolling(10);
  motions.nose_rad = motions.track_rad = 1;
  CHECK(autopilot.fly(tactical().airframe, {0, 0, 35}, motions, kStep_s).rudder == Approx(0));
  motions.nose_rad = 1.1;
  CHECK(autopilot.fly(tactical().airframe, {0, 0, 35}, motions, kStep_s).rudder < -0.1);
  motions.nose_rad = 0.9;
  CHECK(autopilot.fly(tactical().airframe, {0, 0, 35}, motions, kStep_s).rudder > 0.1);
}

TEST_CASE("on the ground it accelerates, rotates or brakes as is demanded") {
  const Controls takes_off = at_once({0, 0, 35}, rolling(10));
  CHECK(takes_off.throttle == 1);
  CHECK(takes_off.brakes == 0);
  CHECK(takes_off.elevator == 0);
  CHECK(at_once({0, 0.1, 35}, rolling(20)).elevator > 0.2);
  const Controls stops = at_once({}, rolling(15));
  CHECK(stops.throttle == 0);
  CHECK(stops.brakes > 0.2);
}

TEST_CASE("an aircraft can fly as its rules say", "[aircraft_type]") {
  const std::string name = GENERATE("medium", "tactical");
  CAPTURE(name);
  const AircraftType& type = aircraft_type(name);
  const double fuel_kg = name == "medium" ? 80 : 4;
  const double mass = type.airframe.empty_mass_kg + fuel_kg;
  CHECK(type.rules.approach_m_s > 1.15 * stall_speed_m_s(type.airframe, mass, 0));
  CHECK(type.rules.cruise_m_s >
        1.3 * stall_speed_m_s(type.airframe, mass, type.rules.greatest_bank_rad));

  Aircraft aircraft;
  aircraft.on_ground = false;
  aircraft.position.height_m = 500;
  aircraft.airspeed_m_s = type.rules.cruise_m_s;
  aircraft.fuel_kg = fuel_kg;
  const auto fly = [&](double climb_rad) {
    for (int i = 0; i < 3000; ++i)
      aircraft =
          advance(type.airframe, aircraft, {0, climb_rad, type.rules.cruise_m_s}, {}, 0, kStep_s);
  };
  fly(0);
  const double burnt_kg_s = (fuel_kg - aircraft.fuel_kg) / 60;
  CHECK(burnt_kg_s <= type.fuel_kg_s);
  CHECK(burnt_kg_s > type.fuel_kg_s / 2);
  fly(type.rules.greatest_climb_rad);
  CHECK(aircraft.airspeed_m_s > 0.97 * type.rules.cruise_m_s);
}

TEST_CASE("an aircraft that nobody knows is refused with those that are known", "[aircraft_type]") {
  CHECK_THROWS_WITH(aircraft_type("large"),
                    "'large' is no aircraft; there are medium and tactical");
}

}  // namespace autopilot_test
