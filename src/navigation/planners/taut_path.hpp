#pragma once

#include <functional>
#include <optional>
#include <vector>

#include "navigation/planners/planning_scene.hpp"
#include "navigation/terrain/plane_geometry.hpp"

namespace skein::navigation {

using GroundPath = std::vector<GroundPoint>;
using LegCost = std::function<double(const GroundPoint&, const GroundPoint&)>;

inline double length_of_leg(const GroundPoint& a, const GroundPoint& b) { return distance_m(a, b); }

/// Inserts points into long legs, so that none is longer than `longest_m`.
GroundPath divide(const GroundPath& path, double longest_m);

/// Leaves out points that are closer together than `step_m`, where the leg past them is free.
GroundPath thin(const PlanningScene& scene, const GroundPath& path, double step_m);

/// The cheapest way to fly from the first point of `path` to its last by straight legs between some
/// of its points, with a turn of radius `turn_radius_m` fitting at each; nothing where there is
/// none. Exact over all choices of points: dynamic programming over pairs of them. Throws NoRoute
/// when the scene's budget is spent.
std::optional<GroundPath> pull_taut(const PlanningScene& scene, const GroundPath& path,
                                    const LegCost& cost, double turn_radius_m);

/// Replaces corners by arcs of `turn_radius_m`, as tangents that touch the arc every few degrees:
/// the path that the aircraft flies, not the one that it cuts.
GroundPath round_corners(const GroundPath& path, double turn_radius_m);

}  // namespace skein::navigation
