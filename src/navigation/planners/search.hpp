#pragma once

#include <functional>

#include "navigation/planners/planners.hpp"

// The planners' searches, of which make_planner() makes planners.
namespace skein::navigation {

/// The task of one search, and its means.
struct Search {
  TerrainProvider& terrains;
  const PlannerOptions& options;
  const AE_navigator::Problem& problem;
  /// Told of each route that is better than those before it, except for the last.
  std::function<void(const AE_navigator::Route&)> report;
};

AE_navigator::Route search_a_star(const Search& search);
AE_navigator::Route search_capped_a_star(const Search& search);
AE_navigator::Route search_rrt_connect(const Search& search);
AE_navigator::Route search_rrt_star(const Search& search);
AE_navigator::Route search_informed_rrt_star(const Search& search);
AE_navigator::Route search_prm_star(const Search& search);
AE_navigator::Route search_legacy_dubins(const Search& search);

}  // namespace skein::navigation
