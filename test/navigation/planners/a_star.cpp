#include <catch2/catch.hpp>
#include <cmath>

#include "test/navigation/demo.hpp"
#include "test/navigation/flat_crossing.hpp"

using namespace skein::navigation;
using namespace skein::navigation::testing;
using AE_navigator::Position;
using AE_navigator::Problem;
using AE_navigator::Route;

namespace {

/// How far north of the line from start to goal the route is at that distance east.
double offset_m(const Route& route, double east_m) {
  for (std::size_t i = 1; i < route.waypoints.size(); ++i) {
    const Position& a = route.waypoints[i - 1];
    const Position& b = route.waypoints[i];
    if (b.east_m < east_m) continue;
    const double share = (east_m - a.east_m) / (b.east_m - a.east_m);
    return std::lerp(a.north_m, b.north_m, share) - 55000;
  }
  return route.waypoints.back().north_m - 55000;
}

}  // namespace

TEST_CASE(
    "Without a weight on exposure the shortest path is flown, through the middle of a radar") {
  FlatCrossing crossing;
  crossing.problem.exposure_weight = 0;
  const Route route = crossing.plan();
  CHECK(route.length_m == Approx(40000).margin(40));
  CHECK(route.radar_exposure > 1e6);
}

TEST_CASE("A route along the terrain's edge stays on the terrain, whatever the grid's spacing") {
  const auto terrains = std::make_shared<TerrainProvider>();
  // 22 pieces of 6400 m: their sum is a rounding error more.
  const auto terrain =
      std::make_shared<const Terrain>(make_terrain(65, 100, [](double, double) { return 0.0; }));
  terrains->add(terrain);
  Problem problem;
  problem.terrain = "made";
  problem.start = {3000, 1000, 300};
  problem.goal = {3000, 5000, 300};
  problem.no_fly_zones = {{"wall", {{0, 3000}, {0, 3200}, {6250, 3200}, {6250, 3000}}, 0, 0, 1000}};
  problem.limits = {30, 10, 0, 900};
  PlannerOptions options;
  options.grid_spacing_m = 300;
  const Route route = make_planner("AStar", terrains, options)->plan(problem);
  const HeightGrid ground{65, 65, 100, 100, terrain->heights_m()};
  CHECK(violations(problem, route, ground) == "");
}

TEST_CASE("With a weight a detour is flown that costs less than it saves") {
  FlatCrossing crossing;
  const Route detour = crossing.plan();
  crossing.problem.exposure_weight = 0;
  const Route straight = crossing.plan();
  crossing.problem.exposure_weight = 1;
  CHECK(detour.length_m > straight.length_m + 500);
  CHECK(cost_m(crossing.problem, detour) < 0.1 * cost_m(crossing.problem, straight));
  CHECK(std::abs(offset_m(detour, 55000)) > 6000);
}

TEST_CASE("The more exposure weighs, the longer and the less exposed is the route") {
  FlatCrossing crossing;
  double length = 0;
  double exposure = INFINITY;
  for (const double weight : {0.0, 0.05, 0.5, 5.0}) {
    crossing.problem.exposure_weight = weight;
    const Route route = crossing.plan();
    CHECK(route.length_m > length - 1);
    CHECK(route.radar_exposure < exposure);
    length = route.length_m;
    exposure = route.radar_exposure;
  }
}

TEST_CASE("Around a single radar the cheapest route is symmetric") {
  const FlatCrossing crossing;
  const Route route = crossing.plan();
  for (double east = 1000; east < 20000; east += 1000) {
    // The grid is some 430 m wide; a route may lean by about one of its cells.
    CHECK(offset_m(route, 55000 - east) == Approx(offset_m(route, 55000 + east)).margin(600));
  }
}

TEST_CASE("There and back cost the same") {
  FlatCrossing crossing;
  const double there = cost_m(crossing.problem, crossing.plan());
  std::swap(crossing.problem.start, crossing.problem.goal);
  CHECK(cost_m(crossing.problem, crossing.plan()) == Approx(there).epsilon(0.01));
}

TEST_CASE("A grid twice as fine finds hardly anything better, and anything else nothing") {
  const Demo demo;
  PlannerOptions fine;
  fine.grid_spacing_m = 100;
  const double cost = demo.cost_m(demo.plan("AStar"));
  const double best = demo.cost_m(demo.plan("AStar", fine));
  CHECK(cost < 1.03 * best);
  const Route quick = demo.plan("RRTConnect");
  CHECK(cost < demo.cost_m(quick));
}

TEST_CASE("A zone is passed by the aircraft's turn, not only by the corner of its path") {
  FlatCrossing crossing;
  crossing.problem.radar_sites.clear();
  crossing.problem.no_fly_zones = {{"Wall", {{45000, 55000}, {56000, 55000}}, 200, -1000, 9000}};
  const Route route = crossing.plan();
  CHECK(violations(crossing.problem, route, crossing.ground()).empty());
  CHECK(route.length_m > 40000);
  CHECK(route.length_m < 40400);
}

TEST_CASE("A hairpin that is too tight for a turn is flown by a curve that swings out") {
  FlatCrossing crossing;
  crossing.problem.radar_sites.clear();
  crossing.problem.start = {55000, 54000, 300};
  crossing.problem.goal = {55000, 56000, 300};
  crossing.problem.no_fly_zones = {{"Wall", {{30000, 55000}, {62000, 55000}}, 200, -1000, 9000}};
  crossing.problem.limits.speed_m_s = 120;
  const Route route = crossing.plan();
  CHECK(violations(crossing.problem, route, crossing.ground()) == "");
  CHECK(route.length_m > 14000);
}

TEST_CASE("A zone whose floor is above the route is flown under") {
  FlatCrossing crossing;
  crossing.problem.radar_sites.clear();
  crossing.problem.no_fly_zones = {{"High", {{55000, 55000}}, 3000, 600, 9000}};
  CHECK(crossing.plan().length_m == Approx(40000).margin(40));
}
