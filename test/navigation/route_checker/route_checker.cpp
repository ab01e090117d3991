#include "navigation/route_checker/route_checker.hpp"

#include <catch2/catch.hpp>
#include <cmath>

#include "skein/error.hpp"

using namespace skein::navigation;
using AE_navigator::Position;
using AE_navigator::Problem;
using AE_navigator::Route;

namespace {

/// Level ground at 100 m, 20 km square.
HeightGrid level() { return {201, 201, 100, 100, std::vector<float>(201 * 201, 100)}; }

/// East for 8 km, a bend of atan(3/4), and 10 km on: all figures by hand.
struct Flight {
  Problem problem;
  Route route;
};

Flight flight() {
  Flight flight;
  flight.problem.start = {4000, 2000, 300};
  flight.problem.goal = {10000, 18000, 300};
  flight.problem.minimum_height_above_ground_m = 200;
  flight.problem.limits = {60, 10, 30, 1000};
  flight.route.waypoints = {{4000, 2000, 300}, {4000, 10000, 300}, {10000, 18000, 300}};
  flight.route.length_m = 18000;
  flight.route.lowest_height_above_ground_m = 200;
  flight.route.radar_exposure = 0;
  return flight;
}

std::vector<RouteRule> rules(const Flight& flight, const HeightGrid& ground = level()) {
  std::vector<RouteRule> broken;
  for (const auto& violation : check_route(flight.problem, flight.route, ground)) {
    broken.push_back(violation.rule);
  }
  return broken;
}

using Rules = std::vector<RouteRule>;

}  // namespace

TEST_CASE("A flight whose figures are right by hand breaks no rule") {
  CHECK(rules(flight()) == Rules{});
}

TEST_CASE("Exposure is the integral of the inverse fourth power") {
  Flight passing = flight();
  passing.problem.start = {4000, 2000, 300};
  passing.problem.goal = {4000, 18000, 300};
  passing.route.waypoints = {passing.problem.start, passing.problem.goal};
  passing.route.length_m = 16000;
  passing.problem.radar_sites = {{"R", {7000, 10000}, 20, 5000, 2}};
  const double h = std::hypot(3000, 180);
  const double l = 8000;
  passing.route.radar_exposure =
      2 * std::pow(5000, 4) * (l / (h * h * (h * h + l * l)) + std::atan(l / h) / std::pow(h, 3));
  RouteTolerances exact;
  exact.exposure_share = 0.001;
  exact.exposure_m = 0;
  CHECK(check_route(passing.problem, passing.route, level(), exact).empty());
  passing.route.radar_exposure *= 1.002;
  CHECK(check_route(passing.problem, passing.route, level(), exact).size() == 1);
}

TEST_CASE("A single post that stands out is found wherever the edge passes it") {
  HeightGrid ground = level();
  ground.heights_m[40 * 201 + 55] = 150;  // On the first edge, at 4000 m north and 5500 m east.
  CHECK(rules(flight(), ground) == Rules{RouteRule::Ground, RouteRule::LowestHeight});
  ground.heights_m[40 * 201 + 55] = 100;
  ground.heights_m[42 * 201 + 55] = 900;  // 200 m aside: no cell of it is crossed.
  CHECK(rules(flight(), ground) == Rules{});
}

TEST_CASE("The ground between posts counts, not only the posts") {
  // A saddle under an edge along its diagonal: both its ends are low, its middle is not.
  HeightGrid ground{2, 2, 1000, 1000, {0, 200, 200, 0}};
  Flight diagonal = flight();
  diagonal.problem.start = {0, 0, 250};
  diagonal.problem.goal = {1000, 1000, 250};
  diagonal.problem.minimum_height_above_ground_m = 149;
  diagonal.route.waypoints = {diagonal.problem.start, diagonal.problem.goal};
  diagonal.route.length_m = std::sqrt(2) * 1000;
  diagonal.route.lowest_height_above_ground_m = 150;
  CHECK(rules(diagonal, ground) == Rules{});
  diagonal.problem.minimum_height_above_ground_m = 151;
  CHECK(rules(diagonal, ground) == Rules{RouteRule::Ground});
}

TEST_CASE("Touching a zone is allowed, entering it by a centimetre is not") {
  Flight beside = flight();
  beside.problem.no_fly_zones = {{"Disc", {{3000, 6000}}, 1000, 0, 1000}};
  CHECK(rules(beside) == Rules{});
  beside.problem.no_fly_zones[0].margin_m += 0.01;
  CHECK(rules(beside) == Rules{RouteRule::Zone});
  beside.problem.no_fly_zones = {
      {"Box", {{3000, 5000}, {3000, 6000}, {4000, 6000}, {4000, 5000}}, 0, 0, 1000}};
  CHECK(rules(beside) == Rules{});
  beside.problem.no_fly_zones[0].outline[2].north_m += 0.01;
  CHECK(rules(beside) == Rules{RouteRule::Zone});
  beside.problem.no_fly_zones = {{"Strip", {{3900, 5000}, {3900, 6000}}, 99.99, 0, 1000}};
  CHECK(rules(beside) == Rules{});
  beside.problem.no_fly_zones[0].margin_m = 100.01;
  CHECK(rules(beside) == Rules{RouteRule::Zone});
}

TEST_CASE("A zone counts between its floor and its ceiling only") {
  Flight under = flight();
  under.problem.no_fly_zones = {{"Z", {{4000, 6000}}, 500, 301, 1000}};
  CHECK(rules(under) == Rules{});
  under.problem.no_fly_zones[0].floor_m = 299;
  CHECK(rules(under) == Rules{RouteRule::Zone});
  under.problem.no_fly_zones[0] = {"Z", {{4000, 6000}}, 500, 0, 299};
  CHECK(rules(under) == Rules{});
}

TEST_CASE("An edge that climbs or descends enters a zone only at the zone's altitudes") {
  Flight climb = flight();
  climb.problem.goal.altitude_m = climb.route.waypoints[2].altitude_m = 700;
  climb.route.waypoints[1].altitude_m = 600;
  climb.route.length_m = std::hypot(8000, 300) + std::hypot(10000, 100);
  CHECK(rules(climb) == Rules{});
  // Half way along the first edge it is at 450 m.
  climb.problem.no_fly_zones = {{"Z", {{4000, 6000}}, 500, 0, 1000}};
  CHECK(rules(climb) == Rules{RouteRule::Zone});
  climb.problem.no_fly_zones[0].ceiling_m = 430;
  CHECK(rules(climb) == Rules{});
  climb.problem.no_fly_zones[0].ceiling_m = 440;
  CHECK(rules(climb) == Rules{RouteRule::Zone});
  std::swap(climb.problem.start, climb.problem.goal);
  std::swap(climb.route.waypoints[0], climb.route.waypoints[2]);
  CHECK(rules(climb) == Rules{RouteRule::Zone});
}

TEST_CASE("An edge that passes a whole zone between two waypoints enters it") {
  Flight through = flight();
  through.problem.no_fly_zones = {
      {"Thin", {{3999, 6000}, {3999, 6001}, {4001, 6001}, {4001, 6000}}, 0, 0, 1000}};
  CHECK(rules(through) == Rules{RouteRule::Zone});
}

TEST_CASE("A zone inside of a bend is entered by the turn though not by the edges") {
  Flight bend = flight();
  // The turn begins 212 m before the waypoint; half way it is some 33 m inside of it.
  bend.problem.no_fly_zones = {{"Z", {{4060, 9985}}, 30, 0, 1000}};
  const auto found = check_route(bend.problem, bend.route, level());
  REQUIRE(found.size() == 1);
  CHECK(found[0].rule == RouteRule::Zone);
  CHECK_THAT(found[0].text, Catch::Contains("the turn at waypoint 1"));
  bend.problem.limits.maximum_bank_angle_deg = 0;
  CHECK(rules(bend) == Rules{});
}

TEST_CASE("A zone inside of a turn that its arc passes by is not entered") {
  Flight bend = flight();
  // Half way the turn is some 34 m inside of the waypoint; the zone begins 40 m inside of it.
  bend.problem.no_fly_zones = {{"Z", {{4114, 9962}}, 80, 0, 1000}};
  CHECK(rules(bend) == Rules{});
}

TEST_CASE("A hill inside of a bend is too close to the turn though not to the edges") {
  // Posts every 10 m; one of them stands out 30 m inside of the bend, where only the arc passes.
  Flight bend = flight();
  bend.problem.start = {400, 200, 300};
  bend.problem.goal = {1000, 1800, 300};
  bend.route.waypoints = {{400, 200, 300}, {400, 1000, 300}, {1000, 1800, 300}};
  bend.route.length_m = 1800;
  HeightGrid ground{201, 201, 10, 10, std::vector<float>(201 * 201, 100)};
  ground.heights_m[43 * 201 + 99] = 105;
  const auto found = check_route(bend.problem, bend.route, ground);
  REQUIRE(found.size() == 1);
  CHECK(found[0].rule == RouteRule::Ground);
  CHECK_THAT(found[0].text, Catch::Contains("the turn at waypoint 1") &&
                                Catch::Contains("the minimum is 200.0 m"));
  // Half way round the aircraft is at the waypoint's altitude.
  bend.route.waypoints[1].altitude_m = 310;
  bend.route.length_m = std::hypot(800, 10) + std::hypot(1000, 10);
  CHECK(rules(bend, ground) == Rules{});
  bend.route.waypoints[1].altitude_m = 300;
  bend.route.length_m = 1800;
  bend.problem.limits.maximum_bank_angle_deg = 0;
  CHECK(rules(bend, ground) == Rules{});
}

TEST_CASE("Two turns must fit on the edge between them") {
  Flight zigzag = flight();
  // Two turns of 90 degrees with a radius of 636 m take 1272 m.
  zigzag.problem.goal = {5300, 8000, 300};
  zigzag.route.waypoints = {
      {4000, 2000, 300}, {4000, 5000, 300}, {5300, 5000, 300}, {5300, 8000, 300}};
  zigzag.route.length_m = 7300;
  CHECK(rules(zigzag) == Rules{});
  zigzag.problem.goal.north_m = zigzag.route.waypoints[2].north_m =
      zigzag.route.waypoints[3].north_m = 5250;
  zigzag.route.length_m = 7250;
  CHECK(rules(zigzag) == Rules{RouteRule::Turn});
}

TEST_CASE("A reversal is no turn") {
  Flight back = flight();
  back.problem.goal = {4000, 6000, 300};
  back.route.waypoints = {{4000, 2000, 300}, {4000, 10000, 300}, {4000, 6000, 300}};
  back.route.length_m = 12000;
  CHECK(rules(back) == Rules{RouteRule::Turn, RouteRule::Turn});
}

TEST_CASE("A route of hostile length is refused before its exposure is summed up") {
  Flight endless = flight();
  endless.problem.radar_sites = {{"R", {7000, 10000}, 20, 5000, 1}};
  endless.route.waypoints.clear();
  for (int i = 0; i < 3000; ++i) {
    endless.route.waypoints.push_back({i % 2 * 20000.0, i % 2 * 20000.0, 300.0});
  }
  const Rules broken = rules(endless);
  CHECK(std::count(broken.begin(), broken.end(), RouteRule::Exposure) == 0);
  CHECK(std::count(broken.begin(), broken.end(), RouteRule::Length) == 2);
}

TEST_CASE("A grid that does not hold together is an error, not a judgement") {
  CHECK_THROWS_AS(rules(flight(), HeightGrid{}), skein::InvalidArgument);
  HeightGrid short_grid = level();
  short_grid.heights_m.pop_back();
  CHECK_THROWS_AS(rules(flight(), short_grid), skein::InvalidArgument);
}
