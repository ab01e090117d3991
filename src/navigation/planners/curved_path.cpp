#include "navigation/planners/curved_path.hpp"

#include <cmath>

#include "navigation/planners/dubins.hpp"

namespace skein::navigation {
namespace {

/// At each point along the line from the one before to the one after.
std::vector<Pose> poses_along(const GroundPath& path) {
  std::vector<Pose> poses;
  for (std::size_t i = 0; i < path.size(); ++i) {
    const GroundPoint& before = path[i > 0 ? i - 1 : 0];
    const GroundPoint& after = path[std::min(i + 1, path.size() - 1)];
    const double heading = std::atan2(after.east_m - before.east_m, after.north_m - before.north_m);
    poses.push_back({path[i], heading});
  }
  return poses;
}

}  // namespace

std::optional<GroundPath> curve(const PlanningScene& scene, const GroundPath& path,
                                double turn_radius_m) {
  // Where two pieces meet, their ends differ by rounding; the edge between them would have any
  // heading.
  constexpr double kSamePlace_m = 0.01;
  if (turn_radius_m == 0) return std::nullopt;
  const std::vector<Pose> poses = poses_along(path);
  GroundPath curved{path.front()};
  for (std::size_t i = 1; i < poses.size(); ++i) {
    const GroundPath piece = DubinsPath(poses[i - 1], poses[i], turn_radius_m).waypoints();
    for (std::size_t point = 1; point < piece.size(); ++point) {
      if (!scene.free(curved.back(), piece[point], Berth::Least)) return std::nullopt;
      if (distance_m(curved.back(), piece[point]) > kSamePlace_m) curved.push_back(piece[point]);
    }
  }
  return curved;
}

}  // namespace skein::navigation
