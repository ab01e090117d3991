#include "planning_value.hpp"

#include <cmath>

#include "navigation/terrain/plane_geometry.hpp"

namespace skein::navigation {

Features features_of(const AE_navigator::Problem& problem, Duration time) {
  const auto number = [](const auto& items) { return static_cast<double>(items.size()); };
  Features features{{"distance_m", slant_range_m(problem.start, problem.goal)},
                    {"zones", number(problem.no_fly_zones)},
                    {"threats", number(problem.radar_sites) + number(problem.missile_sites)},
                    {"exposure_weight", problem.exposure_weight},
                    {"exposure_cap_m", problem.exposure_cap_m},
                    {"time_ms", std::chrono::duration<double, std::milli>(time).count()}};
  // A caller's problem may hold what is no number: the planners say what is wrong with it.
  std::erase_if(features, [](const Feature& feature) { return !std::isfinite(feature.value); });
  return features;
}

double quality_of(const AE_navigator::Problem& problem, const AE_navigator::Route& route) {
  const double cost_m = route.length_m + problem.exposure_weight * route.radar_exposure +
                        problem.kill_weight_m * route.expected_kills;
  return cost_m > 0 ? slant_range_m(problem.start, problem.goal) / cost_m : 1;
}

}  // namespace skein::navigation
