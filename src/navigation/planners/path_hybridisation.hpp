#pragma once

#include <optional>
#include <vector>

#include "navigation/planners/planners.hpp"

namespace skein::navigation {

/// One route of several: the cheapest way along parts of them, changing from one to another where a
/// short straight leg is free, made into a route as a planner makes it (path hybridisation: Raveh,
/// Enosh, Halperin, "A little more, a lot better", 2011). For the synthesis of a Task whose
/// planners all work.
///
/// The result keeps the promise of all planners (`planners.hpp`) and costs less than each of
/// `routes`, by length and what the Problem says threats cost; its planner is named after those
/// whose parts it flies. Nothing where there is no such route, or not in time. `routes` have passed
/// the evaluation: they are taken for flyable. Throws InvalidProblem.
std::optional<AE_navigator::Route> hybridise(TerrainProvider& terrains,
                                             const AE_navigator::Problem& problem,
                                             const std::vector<AE_navigator::Route>& routes,
                                             const PlannerOptions& options = {});

}  // namespace skein::navigation
