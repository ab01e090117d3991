#pragma once

#include <optional>

#include "navigation/planners/planning_scene.hpp"
#include "navigation/planners/taut_path.hpp"

namespace skein::navigation {

/// A path by way of the same points for an aircraft that turns no tighter than `turn_radius_m`, as
/// Dubins paths from each point to the next: where a corner is too tight it swings out or flies a
/// loop. Nothing where there is no room for that, or where the radius is 0.
std::optional<GroundPath> curve(const PlanningScene& scene, const GroundPath& path,
                                double turn_radius_m);

}  // namespace skein::navigation
