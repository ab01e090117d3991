#pragma once

#include <memory>

#include "navigation/grid/grid_planner.hpp"

namespace skein::navigation::grid {

using SharedMap = std::shared_ptr<const GridMap>;

std::unique_ptr<GridPlanner> make_plain_a_star(SharedMap map);
std::unique_ptr<GridPlanner> make_canonical_a_star(SharedMap map);
/// For planes.
std::unique_ptr<GridPlanner> make_landmark_a_star(SharedMap map);
/// For planes.
std::unique_ptr<GridPlanner> make_jump_point_search(SharedMap map);
/// For planes.
std::unique_ptr<GridPlanner> make_lazy_theta_star(SharedMap map);

/// The length of a path by its corners.
double length_of(const std::vector<Cell>& corners);

}  // namespace skein::navigation::grid
