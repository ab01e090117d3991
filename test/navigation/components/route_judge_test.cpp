#include "navigation/components/route_judge.hpp"

#include <catch2/catch.hpp>
#include <cmath>
#include <limits>

using namespace skein::navigation;
using AE_navigator::Problem;
using AE_navigator::Route;
using Catch::Contains;

namespace {

/// A plain 10 km by 10 km at 100 m, and a route across it that stays 200 m above it.
const Terrain kPlain("plain", 11, 11, 1000, 1000, std::vector<float>(121, 100));

Problem problem() {
  Problem problem;
  problem.start = {1000, 1000, 300};
  problem.goal = {9000, 9000, 300};
  problem.no_fly_zones = {{"City", {{5000, 2000}}, 500, 0, 1000}};
  problem.minimum_height_above_ground_m = 120;
  problem.limits = {60, 12, 30, 1000};
  return problem;
}

Route route() {
  Route route;
  route.waypoints = {{1000, 1000, 300}, {5000, 5000, 320}, {9000, 9000, 300}};
  return route;
}

std::string flaw(const Route& route, const Problem& task = problem(), std::uint32_t epoch = 0) {
  const auto rejection = judgement(kPlain, task, [&] { return epoch; })(route);
  return rejection ? rejection->check + ": " + rejection->reason : "none";
}

}  // namespace

TEST_CASE("a route that keeps clear of everything is passed on") { CHECK(flaw(route()) == "none"); }

TEST_CASE("a route with one flaw is stopped, and the flaw and its place are named") {
  Route bad = route();
  SECTION("no way at all") {
    bad.waypoints = {};
    CHECK_THAT(flaw(bad), Contains("fewer than two"));
  }
  SECTION("a number that is none") {
    bad.waypoints[1].altitude_m = std::numeric_limits<double>::quiet_NaN();
    CHECK_THAT(flaw(bad), Contains("not finite"));
  }
  SECTION("a claim that is no number") {
    bad.radar_exposure = std::numeric_limits<double>::infinity();
    CHECK_THAT(flaw(bad), Contains("not finite"));
  }
  SECTION("another start") {
    bad.waypoints.front().north_m += 5;
    CHECK_THAT(flaw(bad), Contains("5.0 m from the start"));
  }
  SECTION("another goal") {
    bad.waypoints.back().east_m -= 7;
    CHECK_THAT(flaw(bad), Contains("7.0 m from the goal"));
  }
  SECTION("a corner cut through a zone") {
    bad.waypoints[1] = {5000, 2400, 320};
    CHECK_THAT(flaw(bad), Contains("between waypoints 0 and 1") && Contains("'City'"));
  }
  SECTION("too low") {
    bad.waypoints[1].altitude_m = 210;
    CHECK_THAT(flaw(bad), Contains("110.0 m of the ground; 120.0 m are demanded"));
  }
  SECTION("too high") {
    bad.waypoints[1].altitude_m = 1001;
    CHECK_THAT(flaw(bad), Contains("1001 m; the aircraft flies no higher than 1000 m"));
  }
  SECTION("too steep") {
    bad.waypoints.insert(bad.waypoints.begin() + 1, {1100, 1000, 400});
    CHECK_THAT(flaw(bad), Contains("climbs at 45.0 degrees"));
  }
  SECTION("off the map") {
    bad.waypoints[1] = {-10, 5000, 320};
    CHECK_THAT(flaw(bad), Contains("leaves the terrain"));
  }
  SECTION("a turn that does not fit") {
    bad.waypoints = {{1000, 1000, 300}, {1500, 1000, 310}, {1500, 5000, 320}, {9000, 9000, 300}};
    CHECK_THAT(flaw(bad),
               Contains("turn radius: between waypoints 0 and 1 it has 500 m for turns"));
  }
}

TEST_CASE("a turn is judged as it is flown, inside of its waypoint") {
  // The turn of 90 degrees passes 263 m inside of its waypoint.
  Route around = route();
  around.waypoints = {{1000, 1000, 300}, {1000, 9000, 300}, {9000, 9000, 300}};
  Problem task = problem();
  CHECK(flaw(around, task) == "none");
  SECTION("a zone there") {
    task.no_fly_zones.push_back({"Tower", {{1250, 8750}}, 150, 0, 1000});
    CHECK(flaw(around, task) ==
          "turn: in the turn at waypoint 1 it enters the no-fly zone 'Tower'");
  }
  SECTION("a mountain there") {
    std::vector<float> posts(121, 100);
    posts[2 * 11 + 8] = 2800;
    const Terrain mountain("mountain", 11, 11, 1000, 1000, posts);
    const auto rejection = judgement(mountain, task, [] { return 0u; })(around);
    REQUIRE(rejection);
    CHECK_THAT(rejection->reason,
               Contains("in the turn at waypoint 1 it comes within") && Contains("120.0 m"));
  }
}

TEST_CASE("a route over the cap is stopped by the exposure that it has, not by what it claims") {
  Problem watched = problem();
  watched.radar_sites = {{"Alpha", {5000, 8000}, 20, 3000, 1}};
  watched.exposure_cap_m = 1e6;
  CHECK(flaw(route(), watched) == "none");
  watched.exposure_cap_m = 10;
  CHECK_THAT(flaw(route(), watched), Contains("exposure cap: its exposure is"));
  watched.radar_sites.clear();
  CHECK(flaw(route(), watched) == "none");
}

TEST_CASE("a route that was planned with threats of an old epoch is stopped") {
  Problem task = problem();
  task.threat_epoch = 2;
  Route planned = route();
  planned.threat_epoch = 2;
  CHECK(flaw(planned, task, 2) == "none");
  CHECK_THAT(flaw(planned, task, 3),
             Contains("threat epoch: it was planned with threat picture 2"));
  task.threat_epoch = 0;
  CHECK(flaw(planned, task, 3) == "none");
}

TEST_CASE("what is no fault of the planner is not held against it, what is its fault is") {
  Problem task = problem();
  task.threat_epoch = 2;
  const auto judge = judgement(kPlain, task, [] { return 3u; });
  CHECK_FALSE(judge(route())->fault);
  Route low = route();
  low.waypoints[1].altitude_m = 210;
  CHECK(judge(low)->fault);
}
