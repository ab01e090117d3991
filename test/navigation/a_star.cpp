#include <catch2/catch.hpp>
#include <cmath>

#include "demo.hpp"
#include "made_terrain.hpp"

using namespace skein::navigation;
using namespace skein::navigation::testing;
using AE_navigator::Position;
using AE_navigator::Problem;
using AE_navigator::Route;

namespace {

/// A flat tile, the problem of crossing 40 km of it from west to east, and one radar half way.
struct FlatCrossing {
  FlatCrossing() : terrains(std::make_shared<TerrainProvider>(std::vector{folder.path()})) {
    write_hgt(folder.path() / "N00E000.hgt", [](int, int) { return 100; });
    problem.terrain = "N00E000.hgt";
    problem.start = {55000, 35000, 300};
    problem.goal = {55000, 75000, 300};
    problem.radar_sites = {{"R", {55000, 55000}, 20, 6000, 1}};
    problem.minimum_height_above_ground_m = 100;
    problem.limits = {60, 10, 30, 3000};
    problem.exposure_weight = 1;
  }

  Route plan() const { return make_a_star(terrains)->plan(problem); }

  TemporaryFolder folder;
  std::shared_ptr<TerrainProvider> terrains;
  Problem problem;
};

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
  const double cost = cost_m(demo.problem, make_a_star(demo.terrains)->plan(demo.problem));
  const double best = cost_m(demo.problem, make_a_star(demo.terrains, fine)->plan(demo.problem));
  CHECK(cost < 1.03 * best);
  const Route quick = make_rrt_connect(demo.terrains)->plan(demo.problem);
  CHECK(cost < cost_m(demo.problem, quick));
}

TEST_CASE("A zone is passed by the aircraft's turn, not only by the corner of its path") {
  FlatCrossing crossing;
  crossing.problem.radar_sites.clear();
  crossing.problem.no_fly_zones = {{"Wall", {{45000, 55000}, {56000, 55000}}, 200, -1000, 9000}};
  const Route route = crossing.plan();
  CHECK(
      violations(crossing.problem, route, read_height_grid(crossing.folder.path() / "N00E000.hgt"))
          .empty());
  CHECK(route.length_m > 40000);
  CHECK(route.length_m < 40400);
}

TEST_CASE("A zone whose floor is above the route is flown under") {
  FlatCrossing crossing;
  crossing.problem.radar_sites.clear();
  crossing.problem.no_fly_zones = {{"High", {{55000, 55000}}, 3000, 600, 9000}};
  CHECK(crossing.plan().length_m == Approx(40000).margin(40));
}
