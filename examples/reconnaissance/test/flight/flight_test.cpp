// The flight of a point mass, the followers of paths, sensors and how they fail.
#include <catch2/catch.hpp>
#include <cmath>
#include <limits>

#include "flight/angles.hpp"
#include "flight/guidance.hpp"
#include "flight/point_mass.hpp"
#include "flight/sensor_fault.hpp"
#include "flight/sensors.hpp"

namespace flight_test {

using namespace reconnaissance;

namespace {

constexpr double kStep_s = 0.02;
const Airframe kAirframe;

Aircraft flying(double airspeed_m_s = 60, double heading_rad = 0) {
  Aircraft aircraft;
  aircraft.position.height_m = 1000;
  aircraft.airspeed_m_s = airspeed_m_s;
  aircraft.heading_rad = heading_rad;
  aircraft.fuel_kg = 80;
  aircraft.on_ground = false;
  aircraft.north_m_s = airspeed_m_s * std::cos(heading_rad);
  aircraft.east_m_s = airspeed_m_s * std::sin(heading_rad);
  return aircraft;
}

Aircraft parked() {
  Aircraft aircraft;
  aircraft.fuel_kg = 80;
  return aircraft;
}

template <class Until>
double fly(Aircraft& aircraft, const Demand& demand, const Until& until, double longest_s = 600,
           const Wind& wind = {}) {
  for (double time_s = 0; time_s < longest_s; time_s += kStep_s) {
    if (until(aircraft)) return time_s;
    aircraft = advance(kAirframe, aircraft, demand, wind, 0, kStep_s);
  }
  return longest_s;
}

void fly_for(Aircraft& aircraft, const Demand& demand, double seconds, const Wind& wind = {}) {
  fly(
      aircraft, demand, [](const Aircraft&) { return false; }, seconds, wind);
}

Motion motion_of(const Aircraft& aircraft) {
  return {aircraft.position.north_m, aircraft.position.east_m, aircraft.north_m_s,
          aircraft.east_m_s};
}

}  // namespace

TEST_CASE("a level turn has the radius V^2 / (g tan bank)") {
  Aircraft aircraft = flying();
  const Demand turn{radians(30), 0, 60};
  fly_for(aircraft, turn, 10);
  double least = 1e9, greatest = -1e9;
  fly(
      aircraft, turn,
      [&](const Aircraft& a) {
        least = std::min(least, a.position.east_m);
        greatest = std::max(greatest, a.position.east_m);
        return false;
      },
      2 * 3.15 * 636 / 60);
  CHECK(turn_radius_m(60, radians(30)) == Approx(636).epsilon(0.002));
  CHECK((greatest - least) / 2 ==
        Approx(turn_radius_m(aircraft.airspeed_m_s, radians(30))).epsilon(0.01));
}

TEST_CASE("bank and its rate stay within the airframe's limits, whatever is demanded") {
  Aircraft aircraft = flying();
  double last = 0;
  fly(
      aircraft, {radians(80), 0, 60},
      [&](const Aircraft& a) {
        CHECK(a.bank_rad - last <= kAirframe.greatest_bank_rate_rad_s * kStep_s + 1e-12);
        last = a.bank_rad;
        return false;
      },
      10);
  CHECK(aircraft.bank_rad == Approx(kAirframe.greatest_bank_rad).epsilon(1e-3));
}

TEST_CASE("at 60 m/s it climbs at 7 degrees and keeps its speed; without fuel it cannot") {
  Aircraft aircraft = flying();
  fly_for(aircraft, {0, radians(7), 60}, 60);
  CHECK(aircraft.airspeed_m_s == Approx(60).margin(1));
  CHECK(aircraft.position.height_m == Approx(1000 + 60 * 60 * std::sin(radians(7))).epsilon(0.03));

  aircraft = flying();
  aircraft.fuel_kg = 0;
  fly_for(aircraft, {0, radians(7), 60}, 60);
  CHECK(aircraft.airspeed_m_s < 50);
}

TEST_CASE("fuel goes by the work of the engine: a climb takes more than level flight") {
  Aircraft level = flying(), climbing = flying();
  fly_for(level, {0, 0, 60}, 60);
  fly_for(climbing, {0, radians(7), 60}, 60);
  const double level_kg = 80 - level.fuel_kg, climb_kg = 80 - climbing.fuel_kg;
  // 20 to 40 litres an hour are what aircraft of this size take.
  CHECK(level_kg * 60 > 12);
  CHECK(level_kg * 60 < 30);
  CHECK(climb_kg > 2 * level_kg);
}

TEST_CASE(
    "an aircraft that is too slow stalls, loses height, and flies again when it is fast enough") {
  Aircraft aircraft = flying(40);
  aircraft.fuel_kg = 0.001;
  bool stalled = false;
  fly(
      aircraft, {radians(20), radians(7), 60},
      [&](const Aircraft& a) {
        stalled = stalled || a.stalled;
        return stalled && !a.stalled;
      },
      120);
  CHECK(stalled);
  CHECK_FALSE(aircraft.stalled);
  CHECK(aircraft.airspeed_m_s > stall_speed_m_s(kAirframe, mass_kg(kAirframe, aircraft), 0));
  CHECK(stall_speed_m_s(kAirframe, 1000, radians(60)) ==
        Approx(std::sqrt(2) * stall_speed_m_s(kAirframe, 1000, 0)));
}

TEST_CASE("speed demands beyond never-exceed are cut to it") {
  Aircraft aircraft = flying();
  fly_for(aircraft, {0, 0, 200}, 300);
  CHECK(aircraft.airspeed_m_s <= kAirframe.never_exceed_m_s + 0.5);
}

TEST_CASE("wind carries the aircraft over ground and does not change its airspeed") {
  Aircraft aircraft = flying();
  fly_for(aircraft, {0, 0, 60}, 100, {0, 8, 0});
  CHECK(aircraft.position.east_m == Approx(800).margin(8 * kStep_s));
  CHECK(aircraft.airspeed_m_s == Approx(60).margin(0.1));
}

TEST_CASE("it takes off only when it is fast enough, lands on the ground, and stops there") {
  const Wind wind{GENERATE(-5.0, 5.0), 0, 0};  // or from behind
  Aircraft aircraft = parked();
  fly_for(aircraft, {0, 0, 0}, 10, wind);
  CHECK(aircraft.position.north_m == 0);  // its brakes hold it
  fly(
      aircraft, {0, radians(7), 60}, [](const Aircraft& a) { return !a.on_ground; }, 60, wind);
  CHECK(aircraft.airspeed_m_s >= 1.1 * stall_speed_m_s(kAirframe, mass_kg(kAirframe, aircraft), 0));
  CHECK(aircraft.position.north_m > 50);
  CHECK(aircraft.position.north_m < 600);
  fly(
      aircraft, {0, radians(7), 60}, [](const Aircraft& a) { return a.position.height_m > 100; },
      60, wind);
  CHECK(aircraft.position.height_m > 100);

  fly(
      aircraft, {0, radians(-4), 45}, [](const Aircraft& a) { return a.on_ground; }, 120, wind);
  REQUIRE(aircraft.on_ground);
  const double touched_m = aircraft.position.north_m;
  fly(
      aircraft, {0, 0, 0}, [](const Aircraft& a) { return a.north_m_s == 0; }, 60, wind);
  CHECK(aircraft.north_m_s == 0);
  CHECK(aircraft.position.height_m == 0);
  CHECK(aircraft.position.north_m - touched_m < 700);
  const double stopped_m = aircraft.position.north_m;
  fly_for(aircraft, {0, 0, 0}, 10, wind);
  CHECK(aircraft.position.north_m == stopped_m);  // it does not roll back
}

TEST_CASE("a gust that puts it back on its wheels, again and again, does not turn it round") {
  Aircraft aircraft = parked();
  for (double time_s = 0; time_s < 15; time_s += kStep_s)
    aircraft = advance(kAirframe, aircraft, {0, radians(6), 60}, {0, -6, -2}, 0, kStep_s);
  CHECK(std::abs(wrapped(std::atan2(aircraft.east_m_s, aircraft.north_m_s))) < radians(2));
}

TEST_CASE("the kinematic model obeys the same limits, and flies the same turn") {
  Aircraft aircraft = flying();
  for (double time_s = 0; time_s < 20; time_s += kStep_s)
    aircraft = advance_kinematic(kAirframe, aircraft, {radians(60), 0, 60}, {}, 0, kStep_s);
  CHECK(aircraft.bank_rad == Approx(kAirframe.greatest_bank_rad));
  CHECK(aircraft.airspeed_m_s == 60);
}

TEST_CASE("L1 leads onto a line and along it, in a wind of a quarter of the airspeed") {
  const double east_wind = GENERATE(-15.0, 0.0, 15.0);
  const double aside_m = GENERATE(-1500.0, -200.0, 0.0, 300.0, 2000.0);
  const Line line{{0, 0, 1000}, {30'000, 0, 1000}};
  const Wind wind{0, east_wind, 0};
  Aircraft aircraft = flying();
  aircraft.position.east_m = aside_m;
  for (double time_s = 0; time_s < 150; time_s += kStep_s) {
    const double bank = l1_bank_rad({}, motion_of(aircraft), line);
    aircraft = advance(kAirframe, aircraft, {bank, 0, 60}, wind, 0, kStep_s);
  }
  CHECK(std::abs(along(line, motion_of(aircraft)).right_m) < 3);
}

TEST_CASE("L1 turns round where the line goes the other way") {
  const Line line{{0, 0, 1000}, {-30'000, 0, 1000}};
  Aircraft aircraft = flying();
  for (double time_s = 0; time_s < 200; time_s += kStep_s)
    aircraft = advance(kAirframe, aircraft, {l1_bank_rad({}, motion_of(aircraft), line), 0, 60}, {},
                       0, kStep_s);
  CHECK(std::abs(along(line, motion_of(aircraft)).right_m) < 5);
  CHECK(aircraft.north_m_s < -59);
}

TEST_CASE("L1 and the carrot circle in either sense, from outside and from inside, in wind") {
  const bool l1 = GENERATE(true, false);
  const bool clockwise = GENERATE(true, false);
  const double begin_m = GENERATE(-4000.0, -200.0, 900.0);
  const Circle circle{{2000, 0, 1000}, 1000, clockwise};
  const Wind wind{6, 0, 0};
  Aircraft aircraft = flying();
  aircraft.position.north_m = 2000 + begin_m;
  double least = 1e9, greatest = 0;
  for (double time_s = 0; time_s < 500; time_s += kStep_s) {
    const double bank = l1 ? l1_bank_rad({}, motion_of(aircraft), circle)
                           : carrot_bank_rad(400, motion_of(aircraft), circle);
    aircraft = advance(kAirframe, aircraft, {bank, 0, 60}, wind, 0, kStep_s);
    if (time_s < 250) continue;
    const double radius = std::hypot(aircraft.position.north_m - 2000, aircraft.position.east_m);
    least = std::min(least, radius);
    greatest = std::max(greatest, radius);
  }
  CHECK(least > 900);
  CHECK(greatest < 1100);
  const double moment = (aircraft.position.north_m - 2000) * aircraft.east_m_s -
                        aircraft.position.east_m * aircraft.north_m_s;
  CHECK((moment > 0) == clockwise);
}

TEST_CASE("the carrot follower leads onto a line, too") {
  const Line line{{0, 0, 1000}, {30'000, 0, 1000}};
  Aircraft aircraft = flying();
  aircraft.position.east_m = 600;
  for (double time_s = 0; time_s < 150; time_s += kStep_s)
    aircraft = advance(kAirframe, aircraft,
                       {carrot_bank_rad(400, motion_of(aircraft), line), 0, 60}, {}, 0, kStep_s);
  CHECK(std::abs(along(line, motion_of(aircraft)).right_m) < 3);
}

TEST_CASE("the climb follows a sloping line") {
  const Line line{{0, 0, 1000}, {10'000, 0, 1500}};
  Aircraft aircraft = flying();
  for (double time_s = 0; time_s < 100; time_s += kStep_s)
    aircraft =
        advance(kAirframe, aircraft,
                {0, climb_rad(line, motion_of(aircraft), aircraft.position.height_m, 60), 60}, {},
                0, kStep_s);
  CHECK(aircraft.position.height_m ==
        Approx(1000 + 500 * aircraft.position.north_m / 10'000).margin(8));
}

TEST_CASE("a turn begins where its circle leaves the leg") {
  const Line leg{{0, 0, 0}, {5000, 0, 0}}, right_angle{{5000, 0, 0}, {5000, 5000, 0}};
  CHECK(turn_lead_m(600, leg, right_angle) == Approx(600));
  CHECK(turn_lead_m(600, leg, {{5000, 0, 0}, {9000, 0, 0}}) == Approx(0).margin(1e-9));
  CHECK(turn_lead_m(9000, leg, right_angle) == Approx(2500));
}

TEST_CASE("the mid value of three does not follow the one that lies") {
  CHECK(mid_value({1.0, 2.0, 1e9}) == 2.0);
  CHECK(mid_value({std::nullopt, 2.0, 4.0}) == 3.0);
  CHECK(mid_value({std::nullopt, std::numeric_limits<double>::quiet_NaN(), 4.0}) == 4.0);
  CHECK_FALSE(mid_value({}));
  CHECK(*mid_angle_rad({radians(359), radians(1), radians(90)}) == Approx(radians(1)));
  CHECK(*mid_angle_rad({radians(1), radians(359), radians(270)}) == Approx(radians(359)));
}

TEST_CASE("a set that disagrees is voted out, and is heard again when it has agreed for long") {
  Random random(7);
  Voter voter;
  const Aircraft aircraft = flying();
  std::array<SensorModel, 3> models;
  const auto vote = [&](double offset_m) {
    std::array<std::optional<Measurement>, 3> sets;
    for (std::size_t i = 0; i < sets.size(); ++i)
      sets[i] = models[i].measure(aircraft, 0.1, random);
    sets[1]->position.north_m += offset_m;
    return voter.vote(sets, 0.1);
  };
  for (int i = 0; i < 5; ++i) vote(500);
  CHECK_FALSE(voter.out(1));
  for (int i = 0; i < 10; ++i) vote(500);
  CHECK(voter.out(1));
  for (int i = 0; i < 40; ++i) vote(0);
  CHECK(voter.out(1));
  for (int i = 0; i < 20; ++i) vote(0);
  CHECK_FALSE(voter.out(1));
  CHECK_FALSE(voter.out(0));
  CHECK_FALSE(voter.out(2));
}

TEST_CASE("with all sets silent there is no measurement, and with two out the third is heard") {
  Random random(1);
  Voter voter;
  CHECK_FALSE(voter.vote({}, 0.1));
  const auto measured = SensorModel().measure(flying(), 0.1, random);
  CHECK(voter.vote({std::nullopt, std::nullopt, measured}, 0.1));
}

TEST_CASE("sets that measure again after all were silent are heard at once") {
  Random random(1);
  Voter voter;
  for (int i = 0; i < 20; ++i) CHECK_FALSE(voter.vote({}, 0.1));
  REQUIRE((voter.out(0) && voter.out(1) && voter.out(2)));
  SensorModel model;
  for (int i = 0; i < 60; ++i)
    CHECK(voter.vote({std::nullopt, model.measure(flying(), 0.1, random), std::nullopt}, 0.1));
  CHECK_FALSE(voter.out(1));
  CHECK(voter.out(0));
}

TEST_CASE("the error of a position wanders: it is as wide as it says, and near to what it was") {
  Random random(5);
  SensorModel model({.level_m = 3, .wander_time_s = 10});
  const Aircraft aircraft = flying();
  double sum = 0, step = 0, last = 0;
  constexpr int kSamples = 20'000;
  for (int i = 0; i < kSamples; ++i) {
    const double error = model.measure(aircraft, 1, random).position.north_m;
    sum += error * error;
    step += (error - last) * (error - last);
    last = error;
  }
  CHECK(std::sqrt(sum / kSamples) == Approx(3).epsilon(0.1));
  CHECK(std::sqrt(step / kSamples) < 1.5);
}

TEST_CASE("each failure of a sensor does what its name says") {
  Random random(3);
  FailingSensor<double> sensor({.slow_period_s = 1, .delay_s = 0.5, .silent_share = 0.5});
  const auto garbage = [](Random& from) { return 1e6 * from.normal(); };
  const auto wrong = [](double truth) { return truth + 100; };
  double truth = 0;
  const auto next = [&](SensorFailure failure) -> std::optional<double> {
    truth += 1;
    return sensor.pass(truth, failure, 0.1, random, garbage, wrong);
  };
  for (int i = 1; i <= 10; ++i) CHECK(next(SensorFailure::None) == i);
  CHECK_FALSE(next(SensorFailure::Off));
  CHECK(next(SensorFailure::Stuck) == 10);
  CHECK(next(SensorFailure::Stuck) == 10);
  CHECK(next(SensorFailure::Wrong) == 114);
  CHECK(std::abs(*next(SensorFailure::Garbage)) > 1000);
  CHECK(next(SensorFailure::Delayed) == 11);
  CHECK(next(SensorFailure::Delayed) == 12);
  CHECK(next(SensorFailure::None) == 18);
  int changes = 0;
  double last = truth;
  for (int i = 0; i < 30; ++i) {
    const auto slow = next(SensorFailure::Slow);
    if (*slow != last) ++changes;
    last = *slow;
  }
  CHECK(changes == 3);
  int silent = 0;
  for (int i = 0; i < 200; ++i) silent += next(SensorFailure::Intermittent) ? 0 : 1;
  CHECK(silent > 70);
  CHECK(silent < 130);
}

}  // namespace flight_test
