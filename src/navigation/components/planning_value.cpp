#include "planning_value.hpp"

#include <cmath>

namespace skein::navigation {
namespace {

double straight_m(const AE_navigator::Problem& problem) {
  return std::hypot(problem.goal.north_m - problem.start.north_m,
                    problem.goal.east_m - problem.start.east_m,
                    problem.goal.altitude_m - problem.start.altitude_m);
}

}  // namespace

Features features_of(const AE_navigator::Problem& problem, Duration time) {
  const auto number = [](const auto& items) { return static_cast<double>(items.size()); };
  Features features{{"distance_m", straight_m(problem)},
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
  return cost_m > 0 ? straight_m(problem) / cost_m : 1;
}

}  // namespace skein::navigation
