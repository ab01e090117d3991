#include <fmt/core.h>

#include "skein/core/error.hpp"
#include "skein/core/suggestion.hpp"
#include "skein/navigation/planners.hpp"

namespace skein::navigation {

const std::vector<std::string>& planner_names() {
  static const std::vector<std::string> kNames{"AStar", "RRTConnect", "RRTstar"};
  return kNames;
}

std::unique_ptr<AE_navigator::IPlanner> make_planner(const std::string& name,
                                                     std::shared_ptr<TerrainProvider> terrains,
                                                     PlannerOptions options) {
  if (name == "AStar") return make_a_star(std::move(terrains), std::move(options));
  if (name == "RRTConnect") return make_rrt_connect(std::move(terrains), std::move(options));
  if (name == "RRTstar") return make_rrt_star(std::move(terrains), std::move(options));
  throw InvalidArgument(
      fmt::format("there is no planner '{}'{}", name, suggestion(name, planner_names())));
}

}  // namespace skein::navigation
