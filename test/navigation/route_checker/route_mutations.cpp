// The test of the test: a good route that is spoilt in any way is refused for the right reason.

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <functional>
#include <limits>
#include <random>

#include "navigation/terrain/ground_clearance.hpp"
#include "navigation/threats/radar_exposure.hpp"
#include "test/navigation/demo.hpp"

using namespace skein::navigation;
using namespace skein::navigation::testing;
using AE_navigator::Position;
using AE_navigator::Problem;
using AE_navigator::Route;

namespace {

const Demo& demo() {
  static const Demo demo;
  return demo;
}

const Route& good_route() {
  static const Route route = make_planner("AStar", demo().terrains)->plan(demo().problem);
  return route;
}

/// Makes the claims of a spoilt route true again, so that only what was spoilt can be found.
void claim_honestly(const Problem& problem, Route& route) {
  route.length_m = 0;
  route.lowest_height_above_ground_m = std::numeric_limits<double>::infinity();
  for (std::size_t i = 1; i < route.waypoints.size(); ++i) {
    const Position& a = route.waypoints[i - 1];
    const Position& b = route.waypoints[i];
    route.length_m +=
        std::hypot(b.north_m - a.north_m, b.east_m - a.east_m, b.altitude_m - a.altitude_m);
    route.lowest_height_above_ground_m = std::min(route.lowest_height_above_ground_m,
                                                  ground_clearance(*demo().terrain, a, b).lowest_m);
  }
  route.radar_exposure = RadarExposure(*demo().terrain, problem.radar_sites).along(route.waypoints);
}

bool breaks(RouteRule rule, const Problem& problem, const Route& route) {
  const auto found = check_route(problem, route, demo().ground);
  return std::any_of(found.begin(), found.end(),
                     [&](const RouteViolation& violation) { return violation.rule == rule; });
}

Position& middle(Route& route) { return route.waypoints[route.waypoints.size() / 2]; }

Position over(const AE_navigator::GroundPoint& point, double height_m) {
  return {point.north_m, point.east_m,
          demo().terrain->height_m(point.north_m, point.east_m) + height_m};
}

}  // namespace

TEST_CASE("The route that the mutations start from is valid") {
  CHECK(violations(demo().problem, good_route(), demo().ground) == "");
  Route same = good_route();
  claim_honestly(demo().problem, same);
  CHECK(violations(demo().problem, same, demo().ground) == "");
}

TEST_CASE("A route spoilt in one property is refused for that property") {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const double infinity = std::numeric_limits<double>::infinity();
  struct Mutation {
    const char* name;
    RouteRule rule;
    bool honest;  ///< Whether the claims are made true again afterwards.
    std::function<void(Problem&, Route&)> spoil;
  };
  using R = RouteRule;
  const std::vector<Mutation> mutations{
      {"a point in a cylinder", R::Zone, true,
       [](Problem& p, Route& r) { middle(r) = over(p.no_fly_zones[0].outline[0], 300); }},
      {"an edge through a polygon", R::Zone, true,
       [](Problem& p, Route& r) {
         const auto& outline = p.no_fly_zones[1].outline;
         middle(r) = over({(outline[0].north_m + outline[2].north_m) / 2,
                           (outline[0].east_m + outline[2].east_m) / 2},
                          300);
       }},
      {"a zone moved onto the route", R::Zone, false,
       [](Problem& p, Route& r) {
         p.no_fly_zones[0].outline = {{middle(r).north_m, middle(r).east_m}};
       }},
      {"a zone just wide enough to be touched", R::Zone, false,
       [](Problem& p, Route& r) {
         p.no_fly_zones[0].outline = {{middle(r).north_m + 30, middle(r).east_m}};
         p.no_fly_zones[0].margin_m = 31;
       }},
      {"a corner cut by leaving out half of the way", R::Ground, true,
       [](Problem&, Route& r) {
         const auto quarter = static_cast<std::ptrdiff_t>(r.waypoints.size() / 4);
         r.waypoints.erase(r.waypoints.begin() + quarter, r.waypoints.end() - quarter);
       }},
      {"a latitude that is no number", R::Finite, false,
       [=](Problem&, Route& r) { middle(r).north_m = nan; }},
      {"a longitude that is infinite", R::Finite, false,
       [=](Problem&, Route& r) { middle(r).east_m = infinity; }},
      {"an altitude of minus infinity", R::Finite, false,
       [=](Problem&, Route& r) { r.waypoints.front().altitude_m = -infinity; }},
      {"a length that is no number", R::Finite, false,
       [=](Problem&, Route& r) { r.length_m = nan; }},
      {"a height that is no number", R::Finite, false,
       [=](Problem&, Route& r) { r.lowest_height_above_ground_m = nan; }},
      {"an exposure that is infinite", R::Finite, false,
       [=](Problem&, Route& r) { r.radar_exposure = infinity; }},
      {"no waypoints", R::Continuity, false, [](Problem&, Route& r) { r.waypoints.clear(); }},
      {"one waypoint", R::Continuity, false, [](Problem&, Route& r) { r.waypoints.resize(1); }},
      {"a waypoint twice", R::Continuity, true,
       [](Problem&, Route& r) { r.waypoints.insert(r.waypoints.begin() + 5, r.waypoints[5]); }},
      {"another start", R::Start, true,
       [](Problem&, Route& r) { r.waypoints.front().altitude_m += 1; }},
      {"the start left out", R::Start, true,
       [](Problem&, Route& r) { r.waypoints.erase(r.waypoints.begin()); }},
      {"another goal", R::Goal, true,
       [](Problem&, Route& r) { r.waypoints.back().north_m += 0.5; }},
      {"an end before the goal", R::Goal, true, [](Problem&, Route& r) { r.waypoints.pop_back(); }},
      {"the way back", R::Start, true,
       [](Problem&, Route& r) { std::reverse(r.waypoints.begin(), r.waypoints.end()); }},
      {"a point off the terrain", R::Terrain, false,
       [](Problem&, Route& r) { middle(r).east_m = -10; }},
      {"a point far off the terrain", R::Terrain, false,
       [](Problem&, Route& r) { middle(r).north_m = 1e300; }},
      {"a point underground", R::Ground, true,
       [](Problem&, Route& r) { middle(r).altitude_m -= 300; }},
      {"all a little too low", R::Ground, true,
       [](Problem&, Route& r) {
         for (std::size_t i = 1; i + 1 < r.waypoints.size(); ++i) r.waypoints[i].altitude_m -= 5;
       }},
      {"a higher minimum", R::Ground, false,
       [](Problem& p, Route&) { p.minimum_height_above_ground_m += 2; }},
      {"above the maximum altitude", R::Altitude, false,
       [](Problem& p, Route& r) { p.limits.maximum_altitude_m = middle(r).altitude_m - 1; }},
      {"a step up", R::Climb, true, [](Problem&, Route& r) { middle(r).altitude_m += 800; }},
      {"a weaker aircraft", R::Climb, false,
       [](Problem& p, Route&) { p.limits.maximum_climb_angle_deg = 3; }},
      {"a faster aircraft", R::Turn, false, [](Problem& p, Route&) { p.limits.speed_m_s *= 1.2; }},
      {"a point beside the way", R::Turn, true,
       [](Problem&, Route& r) { middle(r).north_m += 400; }},
      {"two points in the wrong order", R::Turn, true,
       [](Problem&, Route& r) { std::swap(r.waypoints[30], r.waypoints[31]); }},
      {"a limit that is no number", R::Climb, false,
       [=](Problem& p, Route&) { p.limits.maximum_climb_angle_deg = nan; }},
      {"a length a little too short", R::Length, false,
       [](Problem&, Route& r) { r.length_m -= 1; }},
      {"a length of nothing", R::Length, false, [](Problem&, Route& r) { r.length_m = 0; }},
      {"a height too good", R::LowestHeight, false,
       [](Problem&, Route& r) { r.lowest_height_above_ground_m += 1; }},
      {"an exposure too good", R::Exposure, false,
       [](Problem&, Route& r) { r.radar_exposure *= 0.9; }},
      {"an exposure of nothing", R::Exposure, false,
       [](Problem&, Route& r) { r.radar_exposure = 0; }},
      {"an exposure below nothing", R::Exposure, false,
       [](Problem&, Route& r) { r.radar_exposure = -r.radar_exposure; }},
  };
  for (const Mutation& mutation : mutations) {
    Problem problem = demo().problem;
    Route route = good_route();
    mutation.spoil(problem, route);
    if (mutation.honest) claim_honestly(problem, route);
    INFO(mutation.name << "\n" << violations(problem, route, demo().ground));
    CHECK(breaks(mutation.rule, problem, route));
  }
}

TEST_CASE("Every violation names its place and its figure") {
  Route route = good_route();
  const std::size_t i = route.waypoints.size() / 2;
  route.waypoints[i].altitude_m += 800;
  const std::string text = violations(demo().problem, route, demo().ground);
  CHECK_THAT(text, Catch::Contains("edge " + std::to_string(i) + " descends at"));
  CHECK_THAT(text, Catch::Contains("edge " + std::to_string(i - 1) + " climbs at"));
  CHECK_THAT(text, Catch::Contains("the limit is 12.00 degrees"));
}

namespace {

void spoil_at_random(int rounds, std::uint32_t seed) {
  std::mt19937 random(seed);
  const auto any = [&](double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(random);
  };
  using Waypoints = std::vector<Position>;
  const std::vector<std::function<void(Waypoints&, std::size_t)>> ways{
      [&](Waypoints& w, std::size_t i) {  // Aside, by more than any turn allows.
        const double heading = any(0, 6.283);
        const double distance = any(2000, 9000);
        w[i].north_m += distance * std::cos(heading);
        w[i].east_m += distance * std::sin(heading);
      },
      [&](Waypoints& w, std::size_t i) { w[i].altitude_m -= any(200, 3000); },
      [&](Waypoints& w, std::size_t i) { w[i].altitude_m += any(3000, 9000); },
      [&](Waypoints& w, std::size_t i) {
        const double bad[] = {std::nan(""), INFINITY, -INFINITY};
        double* const fields[] = {&w[i].north_m, &w[i].east_m, &w[i].altitude_m};
        *fields[random() % 3] = bad[random() % 3];
      },
      [&](Waypoints& w, std::size_t i) { w.resize(i); },
      [&](Waypoints& w, std::size_t i) {
        w.erase(w.begin(), w.begin() + static_cast<std::ptrdiff_t>(i));
      },
      [&](Waypoints& w, std::size_t i) {
        w.insert(w.begin() + static_cast<std::ptrdiff_t>(i), w[i]);
      },
      [&](Waypoints& w, std::size_t i) {
        const Position back = w[i - 1];
        w.insert(w.begin() + static_cast<std::ptrdiff_t>(i) + 1, back);
      },
  };
  for (int round = 0; round < rounds; ++round) {
    Route route = good_route();
    const std::size_t i = 1 + random() % (route.waypoints.size() - 2);
    const std::size_t way = static_cast<std::size_t>(round) % ways.size();
    ways[way](route.waypoints, i);
    const bool measurable =
        std::all_of(route.waypoints.begin(), route.waypoints.end(), [](const Position& p) {
          return std::isfinite(p.north_m) && std::isfinite(p.east_m) && std::isfinite(p.altitude_m);
        });
    if (measurable && round % 2 == 0) claim_honestly(demo().problem, route);
    INFO("way " << way << " at waypoint " << i);
    CHECK_FALSE(check_route(demo().problem, route, demo().ground).empty());
  }
}

}  // namespace

TEST_CASE("A route spoilt at random is refused, wherever it is hit and however honest its claims") {
  spoil_at_random(48, 99);
}

TEST_CASE("Many routes spoilt at random are refused", "[long]") { spoil_at_random(240, 7); }
