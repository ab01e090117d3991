#include <fmt/core.h>

#include "core/suggestion.hpp"
#include "navigation/planners/planners.hpp"
#include "skein/error.hpp"

namespace skein::navigation {

namespace {

struct Maker {
  const char* name;
  std::unique_ptr<AE_navigator::IPlanner> (*make)(std::shared_ptr<TerrainProvider>, PlannerOptions);
};

constexpr Maker kMakers[] = {
    {"AStar", make_a_star},
    {"CappedAStar", make_capped_a_star},
    {"RRTConnect", make_rrt_connect},
    {"RRTstar", make_rrt_star},
    {"InformedRRTstar", make_informed_rrt_star},
    {"PRMstar", make_prm_star},
};

}  // namespace

const std::vector<std::string>& planner_names() {
  static const std::vector<std::string> kNames = [] {
    std::vector<std::string> names;
    for (const Maker& maker : kMakers) names.emplace_back(maker.name);
    return names;
  }();
  return kNames;
}

std::unique_ptr<AE_navigator::IPlanner> make_planner(const std::string& name,
                                                     std::shared_ptr<TerrainProvider> terrains,
                                                     PlannerOptions options) {
  for (const Maker& maker : kMakers) {
    if (name == maker.name) return maker.make(std::move(terrains), std::move(options));
  }
  if (name == "LegacyDubins") return make_legacy_dubins(std::move(terrains), std::move(options));
  throw InvalidArgument(
      fmt::format("there is no planner '{}'{}", name, suggestion(name, planner_names())));
}

}  // namespace skein::navigation
