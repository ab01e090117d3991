#pragma once

#include <stdexcept>
#include <vector>

#include "navigation/planners/planning_scene.hpp"
#include "navigation/planners/taut_path.hpp"
#include "navigation/terrain/plane_geometry.hpp"

namespace skein::navigation {

/// A path that cannot be flown in this way; another one may be.
class Unflyable : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// Gives every point of a path on the map its altitude: as low as the ground all along the edges
/// and under the turns between them, the climb limit, start and goal allow, with as few further
/// points as that needs. Throws Unflyable where start or goal lie too low for the climbs before and
/// after them.
std::vector<AE_navigator::Position> fly_over(const PlanningScene& scene, const GroundPath& path);

}  // namespace skein::navigation
