#include "navigation/planners/path_hybridisation.hpp"

#include <algorithm>
#include <catch2/catch.hpp>

#include "demo.hpp"

using namespace skein::navigation;
using namespace skein::navigation::testing;
using AE_navigator::Route;

namespace {

/// Routes of a planner that is quick and careless, from several seeds.
std::vector<Route> careless_routes(const Demo& demo, std::uint32_t first_seed, std::size_t count) {
  std::vector<Route> routes;
  for (std::uint32_t seed = first_seed; routes.size() < count; ++seed) {
    PlannerOptions options;
    options.seed = seed;
    routes.push_back(make_planner("RRTConnect", demo.terrains, options)->plan(demo.problem));
    routes.back().planner += std::to_string(seed);
  }
  return routes;
}

double least_cost_m(const Demo& demo, const std::vector<Route>& routes) {
  double least = cost_m(demo.problem, routes.front());
  for (const Route& route : routes) least = std::min(least, cost_m(demo.problem, route));
  return least;
}

}  // namespace

TEST_CASE("A hybrid of several routes is valid and cheaper than each of them") {
  const Demo demo;
  int better = 0;
  for (const std::uint32_t seed : {1, 11, 21, 31}) {
    const auto routes = careless_routes(demo, seed, 4);
    const auto hybrid = hybridise(*demo.terrains, demo.problem, routes);
    if (!hybrid) continue;
    ++better;
    CHECK(violations(demo.problem, *hybrid, demo.ground) == "");
    CHECK(cost_m(demo.problem, *hybrid) < least_cost_m(demo, routes));
  }
  CHECK(better >= 3);
}

TEST_CASE("A hybrid is named after the planners whose parts it flies") {
  const Demo demo;
  const auto routes = careless_routes(demo, 1, 4);
  const auto hybrid = hybridise(*demo.terrains, demo.problem, routes);
  REQUIRE(hybrid);
  const auto flown = std::count_if(routes.begin(), routes.end(), [&](const Route& route) {
    return hybrid->planner.find(route.planner) != std::string::npos;
  });
  INFO(hybrid->planner);
  CHECK(flown >= 2);
}

TEST_CASE("No routes make no hybrid") {
  const Demo demo;
  CHECK_FALSE(hybridise(*demo.terrains, demo.problem, {}));
}

TEST_CASE("A hybrid for which no time is left is none") {
  Demo demo;
  const auto routes = careless_routes(demo, 1, 4);
  PlannerOptions options;
  options.stop = [] { return true; };
  CHECK_FALSE(hybridise(*demo.terrains, demo.problem, routes, options));
}
