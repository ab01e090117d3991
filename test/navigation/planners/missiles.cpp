#include <catch2/catch.hpp>

#include "test/navigation/flat_crossing.hpp"

using namespace skein::navigation;
using namespace skein::navigation::testing;
using AE_navigator::InvalidProblem;
using AE_navigator::Route;

namespace {

/// Missiles half way, and no radar.
FlatCrossing past_missiles(double kill_weight_m) {
  FlatCrossing crossing;
  crossing.problem.radar_sites.clear();
  crossing.problem.missile_sites = {{"M", {55000, 55000}, 20, 6000, 0.02}};
  crossing.problem.kill_weight_m = kill_weight_m;
  return crossing;
}

}  // namespace

TEST_CASE("Who fears missiles flies around them, who does not flies through, and both say so") {
  const FlatCrossing careless = past_missiles(0);
  const Route through = careless.plan();
  // 12 km at 60 m/s, 200 seconds at 0.02 a second.
  CHECK(through.expected_kills == Approx(4).epsilon(0.01));
  CHECK(violations(careless.problem, through, careless.ground()) == "");

  const FlatCrossing careful = past_missiles(100'000);
  for (const char* const name : {"AStar", "RRTConnect", "RRTstar"}) {
    const Route around = make_planner(name, careful.terrains)->plan(careful.problem);
    INFO(name);
    CHECK(violations(careful.problem, around, careful.ground()) == "");
    if (std::string_view(name) != "RRTConnect") CHECK(around.expected_kills < 0.1);
  }
}

TEST_CASE("A detour around missiles is no longer than a kill is worth") {
  const FlatCrossing crossing = past_missiles(200);
  // Around costs 1.7 km more, through 4 * 200 m.
  CHECK(crossing.plan().expected_kills > 3);
}

TEST_CASE("A wrong claim of expected kills, and an exposure over the cap, are found") {
  FlatCrossing crossing = past_missiles(0);
  Route route = crossing.plan();
  route.expected_kills = 3;
  CHECK_THAT(violations(crossing.problem, route, crossing.ground()),
             Catch::Contains("claimed expected kills: the claimed number"));

  crossing = FlatCrossing();
  crossing.problem.exposure_weight = 0;
  crossing.problem.exposure_cap_m = 100;
  CHECK_THAT(violations(crossing.problem, crossing.plan(), crossing.ground()),
             Catch::Contains("the cap is 100 m"));
}

TEST_CASE("Missiles and weights that make no sense are refused") {
  FlatCrossing crossing = past_missiles(1000);
  SECTION("no reach") { crossing.problem.missile_sites[0].range_m = 0; }
  SECTION("off the terrain") { crossing.problem.missile_sites[0].site = {-1, 0}; }
  SECTION("a rate that is none") { crossing.problem.missile_sites[0].kills_per_second = NAN; }
  SECTION("a weight below zero") { crossing.problem.kill_weight_m = -1; }
  SECTION("a cap below zero") { crossing.problem.exposure_cap_m = -1; }
  CHECK_THROWS_AS(crossing.plan(), InvalidProblem);
}
