#pragma once

#include <string>

#include "navigation/planners/altitude_profile.hpp"
#include "navigation/planners/planning_scene.hpp"
#include "navigation/planners/taut_path.hpp"

namespace skein::navigation {

/// Makes a route of what a search has found: draws the path taut by `cost`, rounds its turns (where
/// they do not fit, the path is flown by Dubins curves), gives it altitudes, measures it, and looks
/// at the result once more, edge by edge and turn by turn. Throws Unflyable where the path has no
/// such route, NoRoute when the budget is spent.
///
/// `max_points` bounds the work: the path is divided into about as many points, and the work grows
/// with their square.
AE_navigator::Route make_route(const PlanningScene& scene, const GroundPath& path,
                               const LegCost& cost, int max_points, std::string planner);

}  // namespace skein::navigation
