#include <catch2/catch.hpp>
#include <functional>
#include <limits>

#include "test/navigation/demo.hpp"
#include "test/navigation/made_terrain.hpp"

using namespace skein::navigation;
using namespace skein::navigation::testing;
using AE_navigator::InvalidProblem;
using AE_navigator::NoRoute;
using AE_navigator::Problem;
using Catch::Contains;

namespace {

/// Why a planner calls the problem invalid.
std::string refusal(AE_navigator::IPlanner& planner, const Problem& problem) {
  try {
    planner.plan(problem);
  } catch (const InvalidProblem& error) {
    return error.reason;
  } catch (const NoRoute& error) {
    return "no route: " + error.reason;
  }
  return "a route";
}

}  // namespace

TEST_CASE("AStar proves that an enclosed goal cannot be reached and names what encloses it") {
  Demo demo;
  demo.problem = unreachable_demo_problem(*demo.terrain);
  const NoRoute refusal = refusal_of([&] { demo.plan("AStar"); });
  CHECK(refusal.proven);
  CHECK_THAT(refusal.reason, Contains("the goal is enclosed") && Contains("'North Wall'") &&
                                 Contains("'South Wall'") && Contains("'East Wall'") &&
                                 Contains("'West Wall'") && !Contains("'City'"));
}

TEST_CASE("AStar names the start where that is what is enclosed") {
  Demo demo;
  demo.problem = unreachable_demo_problem(*demo.terrain);
  std::swap(demo.problem.start, demo.problem.goal);
  CHECK_THAT(refusal_of([&] { demo.plan("AStar"); }).reason, Contains("the start is enclosed"));
}

TEST_CASE("Samplers do not find what is not there, and claim no proof") {
  Demo demo;
  demo.problem = unreachable_demo_problem(*demo.terrain);
  demo.problem.time_limit_ms = 150;
  for (const char* name : {"RRTConnect", "RRTstar", "InformedRRTstar", "PRMstar"}) {
    const NoRoute refusal = refusal_of([&] { demo.plan(name); });
    CHECK_FALSE(refusal.proven);
    CHECK_FALSE(refusal.reason.empty());
  }
}

TEST_CASE("A ring with a gap lets the route in") {
  Demo demo;
  demo.problem = unreachable_demo_problem(*demo.terrain);
  demo.problem.no_fly_zones.pop_back();
  CHECK(demo.violations(demo.plan("AStar")) == "");
}

TEST_CASE("A wall of mountains as high as the maximum altitude is proved to be one") {
  const TemporaryFolder folder;
  write_hgt(folder.path() / "N00E000.hgt",
            [](int, int column) { return column > 590 && column < 610 ? 2000 : 100; });
  Problem problem;
  problem.terrain = "N00E000.hgt";
  problem.start = {50000, 30000, 400};
  problem.goal = {50000, 80000, 400};
  problem.minimum_height_above_ground_m = 100;
  problem.limits = {60, 10, 30, 1500};
  const auto planner =
      make_planner("AStar", std::make_shared<TerrainProvider>(std::vector{folder.path()}));
  CHECK_THAT(refusal(*planner, problem), Contains("ground too high"));
  problem.limits.maximum_altitude_m = 2500;
  CHECK(refusal(*planner, problem) == "a route");
}

TEST_CASE(
    "A problem that makes no sense is refused by every planner, with the rule that it breaks") {
  const Demo demo;
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const double infinity = std::numeric_limits<double>::infinity();
  struct Case {
    std::function<void(Problem&)> spoil;
    const char* reason;
  };
  const std::vector<Case> cases{
      {[](Problem& p) { p.terrain = "moon"; }, "'moon'"},
      {[=](Problem& p) { p.start.north_m = nan; }, "the start has a coordinate"},
      {[=](Problem& p) { p.goal.altitude_m = infinity; }, "the goal has a coordinate"},
      {[](Problem& p) { p.goal.east_m = -1; }, "the goal, 45056 m north and -1 m east, lies off"},
      {[](Problem& p) { p.start.altitude_m -= 200; }, "the start is 50.0 m above the ground"},
      {[](Problem& p) { p.goal.altitude_m += 9000; }, "the maximum altitude is"},
      {[](Problem& p) {
         p.no_fly_zones[0].outline = {{p.goal.north_m + 50, p.goal.east_m}};
       },
       "the goal lies inside the no-fly zone 'City'"},
      {[](Problem& p) { p.no_fly_zones[1].outline.clear(); }, "'Reserve' has 0 corners"},
      {[](Problem& p) { p.no_fly_zones[1].outline.resize(2); }, "no margin"},
      {[](Problem& p) { p.no_fly_zones[0].margin_m = -5; }, "margin of no-fly zone 'City' is -5 m"},
      {[=](Problem& p) { p.no_fly_zones[0].outline[0].east_m = nan; }, "not a finite number"},
      {[=](Problem& p) { p.no_fly_zones[0].ceiling_m = infinity; }, "not a finite number"},
      {[](Problem& p) { std::swap(p.no_fly_zones[0].floor_m, p.no_fly_zones[0].ceiling_m); },
       "above its ceiling"},
      {[](Problem& p) { p.no_fly_zones.resize(1001, p.no_fly_zones[0]); }, "1001 no-fly zones"},
      {[](Problem& p) { p.radar_sites[2].range_m = 0; }, "radar site 'Charlie'"},
      {[=](Problem& p) { p.radar_sites[0].strength = nan; }, "not finite"},
      {[](Problem& p) { p.radar_sites[0].site.north_m = 1e9; }, "stands off the terrain"},
      {[](Problem& p) { p.limits.speed_m_s = 0; }, "the speed is 0 m/s"},
      {[](Problem& p) { p.limits.maximum_climb_angle_deg = 90; }, "climb angle is 90"},
      {[](Problem& p) { p.limits.maximum_bank_angle_deg = -1; }, "bank angle is -1"},
      {[=](Problem& p) { p.limits.maximum_altitude_m = nan; }, "maximum altitude"},
      {[](Problem& p) { p.minimum_height_above_ground_m = -1; },
       "minimum height above ground is -1"},
      {[](Problem& p) { p.exposure_weight = -0.5; }, "exposure weight is -0.5"},
      {[](Problem& p) { p.exposure_weight = 1e38; },
       "exposure weight is 1e+38; it must lie between 0 and 1e+12"},
      {[=](Problem& p) { p.exposure_weight = nan; }, "exposure weight is nan"},
      {[](Problem& p) { p.kill_weight_m = 2e12; }, "weight of an expected kill is 2e+12 m"},
      {[](Problem& p) { p.radar_sites[1].strength = 1e38; },
       "the strength of radar site 'Bravo' is 1e+38; it must be 1e+12 or less"},
  };
  for (const std::string& name : planner_names()) {
    const auto planner = make_planner(name, demo.terrains);
    for (const Case& spoilt : cases) {
      Problem problem = demo.problem;
      problem.time_limit_ms = 20;
      spoilt.spoil(problem);
      INFO(name << " and " << spoilt.reason);
      const std::string reason = refusal(*planner, problem);
      CHECK_THAT(reason, Contains(spoilt.reason));
      CHECK_THAT(reason, !Catch::StartsWith("no route"));
    }
  }
}
