#pragma once

#include "navigation/grid/grid_map.hpp"

namespace skein::navigation::grid {

/// Whether the straight line between two cells' centres touches free cells alone, on a plane. A
/// line that passes through a corner touches all four cells around it.
bool in_sight(const GridMap& map, const Cell& a, const Cell& b);

}  // namespace skein::navigation::grid
