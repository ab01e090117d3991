#include <fmt/core.h>

#include "core/suggestion.hpp"
#include "navigation/planners/search.hpp"
#include "skein/error.hpp"

namespace skein::navigation {

namespace {

struct Planner {
  const char* name;
  AE_navigator::Route (*search)(const Search&);
};

constexpr Planner kPlanners[] = {
    {"AStar", search_a_star},
    {"CappedAStar", search_capped_a_star},
    {"RRTConnect", search_rrt_connect},
    {"RRTstar", search_rrt_star},
    {"InformedRRTstar", search_informed_rrt_star},
    {"PRMstar", search_prm_star},
};
constexpr Planner kLegacyDubins{"LegacyDubins", search_legacy_dubins};

class SearchingPlanner final : public AE_navigator::IPlanner {
 public:
  SearchingPlanner(const Planner& planner, std::shared_ptr<TerrainProvider> terrains,
                   PlannerOptions options)
      : planner_(planner), terrains_(std::move(terrains)), options_(std::move(options)) {
    if (options_.exposure_cap_m >= 0) return;
    throw InvalidArgument(
        fmt::format("the exposure cap is {} m; it must be 0 or more", options_.exposure_cap_m));
  }

  AE_navigator::Route plan(const AE_navigator::Problem& problem) override {
    return search(problem, [](const AE_navigator::Route&) {});
  }

  void improve(const AE_navigator::Problem& problem,
               StreamSink<AE_navigator::Route>& sink) override {
    // A route that the caller has no room for is overtaken by the next.
    sink.push(search(problem, [&](const AE_navigator::Route& route) { sink.try_push(route); }));
  }

 private:
  AE_navigator::Route search(AE_navigator::Problem problem,
                             const std::function<void(const AE_navigator::Route&)>& report) const {
    const std::uint32_t most_ms = options_.time_limit_ms;
    if (most_ms > 0 && (problem.time_limit_ms == 0 || problem.time_limit_ms > most_ms))
      problem.time_limit_ms = most_ms;
    return planner_.search({*terrains_, options_, problem, report});
  }

  const Planner& planner_;
  std::shared_ptr<TerrainProvider> terrains_;
  PlannerOptions options_;
};

}  // namespace

const std::vector<std::string>& planner_names() {
  static const std::vector<std::string> kNames = [] {
    std::vector<std::string> names;
    for (const Planner& planner : kPlanners) names.emplace_back(planner.name);
    return names;
  }();
  return kNames;
}

std::unique_ptr<AE_navigator::IPlanner> make_planner(const std::string& name,
                                                     std::shared_ptr<TerrainProvider> terrains,
                                                     PlannerOptions options) {
  const auto make = [&](const Planner& planner) {
    return std::make_unique<SearchingPlanner>(planner, std::move(terrains), std::move(options));
  };
  for (const Planner& planner : kPlanners) {
    if (name == planner.name) return make(planner);
  }
  if (name == kLegacyDubins.name) return make(kLegacyDubins);
  throw InvalidArgument(
      fmt::format("there is no planner '{}'{}", name, suggestion(name, planner_names())));
}

}  // namespace skein::navigation
