// A whole flight, from standing to standing, with the point mass and sensors that err.
#include "flight/pilot.hpp"

#include <catch2/catch.hpp>
#include <cmath>
#include <functional>

#include "flight/angles.hpp"

namespace pilot_test {

using namespace reconnaissance;

namespace {

constexpr double kStep_s = 0.02;

Guidance l1() {
  return {
      [](const Motion& motion, const Line& line) { return l1_bank_rad({}, motion, line); },
      [](const Motion& motion, const Circle& circle) { return l1_bank_rad({}, motion, circle); }};
}

/// An aircraft and its pilot.
struct Flight {
  explicit Flight(const Wind& wind_ = {}) : wind(wind_) {
    aircraft.position = strip.threshold;
    aircraft.heading_rad = strip.course_rad;
    aircraft.fuel_kg = 80;
  }

  void step() {
    std::array<std::optional<Measurement>, 3> sets;
    for (std::size_t i = 0; i < sets.size(); ++i)
      sets[i] = models[i].measure(aircraft, kStep_s, random);
    const Pilot::Sight sight{*voter.vote(sets, kStep_s), height_m(), aircraft.on_ground};
    const Demand demand = pilot.fly(sight);
    aircraft = advance(airframe, aircraft, demand, wind, ground_m(), kStep_s);
    time_s += kStep_s;
    REQUIRE_FALSE(aircraft.stalled);
  }

  template <class Until>
  bool fly_until(const Until& until, double longest_s = 600) {
    for (const double begin_s = time_s; time_s - begin_s < longest_s; step())
      if (until()) return true;
    return false;
  }

  double ground_m() const { return strip.threshold.height_m + hill_m(aircraft.position); }
  double height_m() const { return aircraft.position.height_m - ground_m(); }

  Airframe airframe;
  Strip strip{{0, 0, 180}, radians(80), 1500};
  Wind wind;
  Aircraft aircraft;
  std::array<SensorModel, 3> models;
  Voter voter;
  Random random{11};
  Pilot pilot{FlightRules{}, l1()};
  std::function<double(const Local&)> hill_m = [](const Local&) { return 0; };
  double time_s = 0;
};

}  // namespace

TEST_CASE("it takes off, flies its legs, and lands on the runway, in wind from each side") {
  const double wind_from = radians(GENERATE(80, 170, 350));
  Flight flight({-5 * std::cos(wind_from), -5 * std::sin(wind_from), 0});
  REQUIRE(flight.pilot.take_off(flight.strip).empty());
  REQUIRE(flight.fly_until([&] { return flight.height_m() > 150; }));
  CHECK(flight.pilot.mode() == Pilot::Mode::TakingOff);

  const Strip& strip = flight.strip;
  const Local here = flight.aircraft.position;
  REQUIRE(
      flight.pilot.follow({here, {6000, 6000, 900}, {9000, 0, 900}, {6000, -6000, 700}}).empty());
  double nearest_m = 1e9;
  REQUIRE(flight.fly_until([&] {
    nearest_m = std::min(nearest_m, std::hypot(flight.aircraft.position.north_m - 9000,
                                               flight.aircraft.position.east_m));
    return flight.pilot.mode() == Pilot::Mode::Waiting;
  }));
  CHECK(flight.pilot.leg() == 3);
  CHECK(nearest_m < 400);
  CHECK(flight.aircraft.position.height_m == Approx(700).margin(25));

  const Local aim = on_centre_line(strip, 150, 0);
  REQUIRE(flight.pilot
              .land({flight.aircraft.position, on_centre_line(strip, -9000, 500),
                     on_centre_line(strip, -4000, 4150 * std::tan(radians(4))), aim},
                    strip)
              .empty());
  REQUIRE(flight.fly_until([&] { return flight.aircraft.on_ground; }));
  const Local touched = flight.aircraft.position;
  INFO("touched down " << touched.north_m << " m north, " << touched.east_m
                       << " m east of the threshold");
  const double beyond_m =
      touched.north_m * std::cos(strip.course_rad) + touched.east_m * std::sin(strip.course_rad);
  const double right_m =
      touched.east_m * std::cos(strip.course_rad) - touched.north_m * std::sin(strip.course_rad);
  CHECK(beyond_m > 0);
  CHECK(beyond_m < 600);
  CHECK(std::abs(right_m) < 20);
  REQUIRE(flight.fly_until([&] { return flight.pilot.mode() == Pilot::Mode::Landed; }, 60));
  CHECK(flight.aircraft.north_m_s < 0.5);
}

TEST_CASE("after its route it waits in a circle at its end, at its height") {
  Flight flight;
  flight.pilot.take_off(flight.strip);
  flight.fly_until([&] { return flight.height_m() > 150; });
  REQUIRE(flight.pilot.follow({flight.aircraft.position, {4000, 4000, 600}}).empty());
  REQUIRE(flight.fly_until([&] { return flight.pilot.mode() == Pilot::Mode::Waiting; }));
  flight.fly_until([] { return false; }, 300);
  CHECK(std::hypot(flight.aircraft.position.north_m - 4000,
                   flight.aircraft.position.east_m - 4000) < 1500);
  CHECK(flight.aircraft.position.height_m == Approx(600).margin(20));
}

TEST_CASE("orders that cannot be obeyed are refused with the reason") {
  Flight flight;
  CHECK(flight.pilot.follow({{}, {1000, 0, 500}}) == "the aircraft is on the ground");
  CHECK(flight.pilot.take_off(flight.strip).empty());
  CHECK(flight.pilot.take_off(flight.strip) == "the aircraft is not parked");
  CHECK(flight.pilot.follow({Local{}}) == "a route has two points or more");
  CHECK(flight.pilot.mode() == Pilot::Mode::TakingOff);
}

TEST_CASE("a pilot circles about a place that it is ordered, and anew when that has moved") {
  Flight flight;
  CHECK(flight.pilot.loiter({{0, 0, 600}, 1200, true}) == "the aircraft is on the ground");
  flight.pilot.take_off(flight.strip);
  REQUIRE(flight.fly_until([&] { return flight.height_m() > 290; }));
  Local centre{4000, 6000, 700};
  REQUIRE(flight.pilot.loiter({centre, 1200, false}).empty());
  CHECK(flight.pilot.mode() == Pilot::Mode::Waiting);
  CHECK(flight.pilot.legs() == 0);
  const auto away_m = [&] { return map_distance_m(flight.aircraft.position, centre); };
  REQUIRE(flight.fly_until([&] { return std::abs(away_m() - 1200) < 30; }));
  flight.fly_until([] { return false; }, 60);
  for (int i = 0; i < 200; ++i) {
    centre.east_m += 8;  // once a second, as far as a vehicle drives
    REQUIRE(flight.pilot.loiter({centre, 1200, false}).empty());
    flight.fly_until([] { return false; }, 1);
    CHECK(away_m() == Approx(1200).margin(150));
  }
  CHECK(flight.aircraft.position.height_m == Approx(700).margin(15));
  // To the left about it, so that its course is a quarter turn from the way to the centre.
  const Local& place = flight.aircraft.position;
  const double course = std::atan2(flight.aircraft.east_m_s, flight.aircraft.north_m_s);
  CHECK(wrapped(flight.pilot.route_course_rad(place) - course) == Approx(0).margin(0.25));
}

TEST_CASE("an advisory leads neither into the ground nor into hills beside the route") {
  const FlightRules rules;
  Airframe airframe;
  Aircraft aircraft;
  aircraft.position = {0, 0, 300};
  aircraft.airspeed_m_s = rules.cruise_m_s;
  aircraft.fuel_kg = 80;
  aircraft.on_ground = false;
  // Hills that rise by a tenth, from 2 km north on.
  const auto ground_m = [&] {
    return std::clamp((aircraft.position.north_m - 2000) / 10, 0., 400.);
  };
  const double asked_m_s = GENERATE(-5, 0);
  double lowest_m = 1e9;
  for (double time_s = 0; time_s < 300; time_s += kStep_s) {
    const double above_m = aircraft.position.height_m - ground_m();
    lowest_m = std::min(lowest_m, above_m);
    const Measurement measured{.position = aircraft.position,
                               .north_m_s = aircraft.north_m_s,
                               .east_m_s = aircraft.east_m_s,
                               .airspeed_m_s = aircraft.airspeed_m_s};
    const Demand demand =
        advised(rules, {0, 0, rules.cruise_m_s}, {measured, above_m, false}, 0, asked_m_s);
    aircraft = advance(airframe, aircraft, demand, {}, ground_m(), kStep_s);
  }
  CHECK(lowest_m > 200);
  CHECK(aircraft.position.north_m > 8000);
}

TEST_CASE("back to its route the aircraft climbs over hills that the route leads around") {
  Flight flight;
  flight.pilot.take_off(flight.strip);
  REQUIRE(flight.fly_until([&] { return flight.height_m() > 250; }));
  // On the way back to it hills rise by a tenth, up to 150 m.
  const Local from = flight.aircraft.position;
  REQUIRE(flight.pilot
              .follow({{from.north_m + 6000, from.east_m - 20000, from.height_m},
                       {from.north_m + 6000, from.east_m + 40000, from.height_m}})
              .empty());
  double lowest_m = 1e9;
  flight.hill_m = [&](const Local& place) {
    return std::clamp((place.north_m - from.north_m - 1500) / 10, 0., 150.) *
           std::clamp((from.north_m + 5400 - place.north_m) / 500, 0., 1.);
  };
  flight.fly_until(
      [&] {
        lowest_m = std::min(lowest_m, flight.height_m());
        return flight.aircraft.position.north_m > from.north_m + 5900;
      },
      300);
  CHECK(flight.aircraft.position.north_m > from.north_m + 5900);
  CHECK(lowest_m > 200);
}

TEST_CASE("an advisory is followed far above the ground") {
  const FlightRules rules;
  const Measurement measured{.north_m_s = 35, .airspeed_m_s = 35};
  const auto climb = [&](double above_m, std::optional<double> asked_m_s) {
    return advised(rules, {0, 0.01, 35}, {measured, above_m, false}, 0, asked_m_s).climb_rad;
  };
  CHECK(climb(400, -3.5) == Approx(std::asin(-0.1)));
  CHECK(climb(400, std::nullopt) == 0.01);
  CHECK(climb(220, std::nullopt) > 0.05);
  CHECK(climb(200, -3.5) > climb(230, -3.5));
  CHECK(climb(230, 3) == Approx(std::asin(3 / 35.)));
}

}  // namespace pilot_test
