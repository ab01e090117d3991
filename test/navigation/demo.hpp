#pragma once

#include <fmt/core.h>

#include <memory>
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

/// The demonstration on one invented terrain, with what a test needs to judge its routes.
struct Demo {
  explicit Demo(std::uint32_t seed = 7)
      : terrains(shared_terrains()),
        terrain(terrains->load("synthetic:" + std::to_string(seed))),
        problem(demo_problem(*terrain)),
        ground{terrain->rows(), terrain->columns(), terrain->north_spacing_m(),
               terrain->east_spacing_m(), terrain->heights_m()} {}

  std::shared_ptr<TerrainProvider> terrains;
  std::shared_ptr<const Terrain> terrain;
  AE_navigator::Problem problem;
  HeightGrid ground;
};

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

}  // namespace skein::navigation::testing
