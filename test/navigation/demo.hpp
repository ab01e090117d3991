#pragma once

#include <fmt/core.h>

#include <chrono>
#include <memory>
#include <stdexcept>
#include <string>

#include "navigation/planners/planners.hpp"
#include "navigation/route_checker/route_checker.hpp"
#include "navigation/routes/demo_problem.hpp"

namespace skein::navigation::testing {

/// One for all tests of a program, as to invent a terrain takes longer than to plan on it.
inline std::shared_ptr<TerrainProvider> shared_terrains() {
  static const auto terrains = std::make_shared<TerrainProvider>();
  return terrains;
}

/// All violations as text, one a line; empty for a valid route.
inline std::string violations(const AE_navigator::Problem& problem,
                              const AE_navigator::Route& route, const HeightGrid& ground) {
  std::string text;
  for (const RouteViolation& violation : check_route(problem, route, ground)) {
    text += fmt::format("{}: {}\n", to_string(violation.rule), violation.text);
  }
  return text;
}

/// What a planner should make small.
inline double cost_m(const AE_navigator::Problem& problem, const AE_navigator::Route& route) {
  return route.length_m + problem.exposure_weight * route.radar_exposure;
}

/// Why there is no route, and whether that is proved.
template <class Plan>
AE_navigator::NoRoute refusal_of(const Plan& plan) {
  try {
    plan();
  } catch (const AE_navigator::NoRoute& refusal) {
    return refusal;
  }
  throw std::logic_error("it found a route");
}

/// Time that is counted in looks at the clock, of which the last one is an hour later, so that a
/// loaded machine changes nothing.
inline PlannerOptions with_looks(int looks) {
  PlannerOptions options;
  options.now = [looks]() mutable { return Instant(std::chrono::hours(--looks > 0 ? 0 : 1)); };
  return options;
}

/// The demonstration on one invented terrain, with what a test needs to judge its routes.
struct Demo {
  explicit Demo(std::uint32_t seed = 7)
      : terrains(shared_terrains()),
        terrain(terrains->load("synthetic:" + std::to_string(seed))),
        problem(demo_problem(*terrain)),
        ground{terrain->rows(), terrain->columns(), terrain->north_spacing_m(),
               terrain->east_spacing_m(), terrain->heights_m()} {}

  AE_navigator::Route plan(const std::string& planner, const PlannerOptions& options = {}) const {
    return make_planner(planner, terrains, options)->plan(problem);
  }
  std::string violations(const AE_navigator::Route& route) const {
    return testing::violations(problem, route, ground);
  }
  double cost_m(const AE_navigator::Route& route) const { return testing::cost_m(problem, route); }

  std::shared_ptr<TerrainProvider> terrains;
  std::shared_ptr<const Terrain> terrain;
  AE_navigator::Problem problem;
  HeightGrid ground;
};

}  // namespace skein::navigation::testing
