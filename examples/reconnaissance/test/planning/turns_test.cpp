// The turns between a planner's way and a straight pass, flown by the pilot in wind.
#include "planning/turns.hpp"

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <numbers>

#include "flight/angles.hpp"
#include "flight/pilot.hpp"
#include "planning/dubins_length.hpp"
#include "planning/threat_discs.hpp"
#include "random.hpp"

namespace turns_test {

using namespace reconnaissance;

namespace {

constexpr double kRadius_m = 982;  // As the flight controller tells planners.

Local place(const RoutePose& pose, double height_m) {
  return {pose.north_m, pose.east_m, height_m};
}

double way_m(const std::vector<Local>& way) {
  double sum = 0;
  for (std::size_t i = 1; i < way.size(); ++i) sum += map_distance_m(way[i], way[i - 1]);
  return sum;
}

/// How an element was passed.
struct Passing {
  double level_m = 0;  ///< So far before the element was abeam the bank was, and stayed, small.
  double aside_m = 0;  ///< Of the element from the track, then.
};

/// Flies a route in wind, and sees how it leads past a place on its last leg.
Passing fly(const std::vector<Local>& route, double course_rad, const Wind& wind,
            const Local& element) {
  Aircraft aircraft;
  aircraft.position = route.front();
  aircraft.airspeed_m_s = 60;
  aircraft.heading_rad = course_rad;
  aircraft.north_m_s = 60 * std::cos(course_rad);
  aircraft.east_m_s = 60 * std::sin(course_rad);
  aircraft.fuel_kg = 80;
  aircraft.on_ground = false;
  Pilot pilot(
      {},
      {[](const Motion& motion, const Line& line) { return l1_bank_rad({}, motion, line); },
       [](const Motion& motion, const Circle& circle) { return l1_bank_rad({}, motion, circle); }});
  REQUIRE(pilot.take_off({{0, 0, 180}, course_rad, 1500}).empty());
  REQUIRE(pilot.follow(route).empty());
  Passing passing;
  for (int step = 0; step < 100'000 && pilot.mode() != Pilot::Mode::Waiting; ++step) {
    const Pilot::Sight sight{
        {aircraft.position, aircraft.north_m_s, aircraft.east_m_s, aircraft.up_m_s,
         aircraft.airspeed_m_s, aircraft.heading_rad, aircraft.climb_rad, aircraft.bank_rad},
        aircraft.position.height_m - 180,
        false};
    aircraft = advance({}, aircraft, pilot.fly(sight), wind, 180, 0.02);
    if (pilot.leg() + 1 < pilot.legs()) continue;
    const double course = std::atan2(aircraft.east_m_s, aircraft.north_m_s);
    const double north = element.north_m - aircraft.position.north_m;
    const double east = element.east_m - aircraft.position.east_m;
    const double ahead_m = north * std::cos(course) + east * std::sin(course);
    passing.aside_m = std::abs(east * std::cos(course) - north * std::sin(course));
    if (ahead_m <= 0) return passing;
    if (std::abs(aircraft.bank_rad) > 0.1)
      passing.level_m = 0;
    else if (passing.level_m == 0)
      passing.level_m = ahead_m;
  }
  FAIL("the element was not passed");
  return passing;
}

/// Whether one of its points is there.
bool leads_over(const std::vector<Local>& way, double north_m, double east_m) {
  return std::ranges::any_of(way, [&](const Local& each) {
    return std::hypot(each.north_m - north_m, each.east_m - east_m) < 1;
  });
}

}  // namespace

TEST_CASE("corners of the shortest way are joined by its straight parts and its arcs") {
  Random random(4);
  for (int i = 0; i < 2000; ++i) {
    const auto anywhere = [&] {
      const double north = 8000 * random.uniform();
      const double east = 8000 * random.uniform();
      return RoutePose{north, east, 6.2831853 * random.uniform()};
    };
    const RoutePose from = anywhere(), to = anywhere();
    const double radius_m = 700;
    const auto corners = dubins_corners(from, to, radius_m);
    // Around each corner the way is shorter by two tangents, and longer by an arc.
    RoutePose here = from;
    double length_m = 0;
    const auto lead_to = [&](const RoutePose& next) {
      const double north = next.north_m - here.north_m, east = next.east_m - here.east_m;
      // On the course that the last corner gave.
      REQUIRE(east * std::cos(here.course_rad) - north * std::sin(here.course_rad) ==
              Approx(0).margin(1e-3));
      REQUIRE(north * std::cos(here.course_rad) + east * std::sin(here.course_rad) > -1e-3);
      length_m += std::hypot(north, east);
      const double turn_rad = std::abs(wrapped(next.course_rad - here.course_rad));
      length_m += radius_m * (turn_rad - 2 * std::tan(turn_rad / 2));
      REQUIRE(turn_rad < radians(61));
      here = next;
    };
    for (const RoutePose& corner : corners) lead_to(corner);
    const double last_m = map_distance_m(to, here);
    CHECK(std::abs(wrapped(to.course_rad - here.course_rad)) < 0.02);
    CHECK(length_m + last_m == Approx(dubins_length_m(from, to, radius_m)).epsilon(0.002));
  }
}

TEST_CASE("from wherever an aircraft comes, in any wind, it flies level past an element") {
  const Local element{0, 0, 180};
  const auto passes = passes_by({element}, {}, {});
  Random random(7);
  for (int i = 0; i < 40; ++i) {
    const CollectionPass& pass = passes[static_cast<std::size_t>(i) % passes.size()];
    const double wind_from = 6.2831853 * random.uniform();
    const Wind wind{-6 * std::cos(wind_from), -6 * std::sin(wind_from), 0};
    const double north_m = 16'000 * (random.uniform() - 0.5);
    const double east_m = 16'000 * (random.uniform() - 0.5);
    const Local start{north_m, east_m, 900};
    const double course_rad = 6.2831853 * random.uniform();
    auto route =
        with_turns({start, place(pass.begin, 930)}, course_rad, pass.begin.course_rad, kRadius_m);
    CHECK(way_m(route) < map_distance_m(start, pass.begin) + 20 * kRadius_m);
    route.push_back(place(pass.end, 930));
    const Passing passing = fly(route, course_rad, wind, element);
    INFO("flight " << i << " from " << north_m << ' ' << east_m);
    CHECK(passing.level_m > 1000);
    CHECK(passing.aside_m == Approx(700).margin(60));
  }
}

TEST_CASE("a way can begin with turns to either side, and leads where it led") {
  const std::vector<Local> way{{0, 0, 500}, {0, 9000, 500}, {2000, 15000, 500}};
  const double north = 0, east = std::numbers::pi / 2;
  for (const int quarters : {-2, -1, 1, 2}) {
    const auto turned = with_turns(way, north, east, 900, quarters);
    const double side = quarters > 0 ? 1 : -1;
    CHECK(leads_over(turned, 900, side * 900));
    if (std::abs(quarters) == 2) CHECK(leads_over(turned, 0, side * 1800));
    // A sharper corner is flown beyond it.
    double course = north;
    for (std::size_t i = 1; i < turned.size(); ++i) {
      const double next = course_between_rad(turned[i - 1], turned[i]);
      CHECK(std::abs(wrapped(next - course)) < radians(61));
      course = next;
    }
    CHECK(turned.back().north_m == 2000);
    CHECK(turned.back().east_m == 15000);
  }
}

TEST_CASE("the points of a way that are far from its ends stay, and heights grow evenly") {
  const std::vector<Local> way{{0, 0, 400},         {500, 100, 420},    {20'000, 0, 800},
                               {30'000, 5000, 900}, {49'000, 100, 950}, {50'000, 0, 1000}};
  const auto turned = with_turns(way, 3.0, 1.5, kRadius_m);
  const auto has = [&](const Local& point) {
    return std::ranges::any_of(turned, [&](const Local& each) {
      return each.north_m == point.north_m && each.east_m == point.east_m &&
             each.height_m == point.height_m;
    });
  };
  CHECK(has(way[0]));
  CHECK_FALSE(has(way[1]));
  CHECK(has(way[2]));
  CHECK(has(way[3]));
  CHECK_FALSE(has(way[4]));
  CHECK(has(way[5]));
  for (std::size_t i = 1; i < turned.size(); ++i)
    CHECK(turned[i].height_m > turned[i - 1].height_m);
}

}  // namespace turns_test
