#include "navigation/planners/turn_arc.hpp"

#include <cmath>
#include <limits>
#include <numbers>

namespace skein::navigation {

using AE_navigator::Position;

double tangent_share(const GroundPoint& a, const GroundPoint& b, const GroundPoint& c) {
  const double north1 = b.north_m - a.north_m;
  const double east1 = b.east_m - a.east_m;
  const double north2 = c.north_m - b.north_m;
  const double east2 = c.east_m - b.east_m;
  const double lengths = std::hypot(north1, east1) * std::hypot(north2, east2);
  const double along = lengths + north1 * north2 + east1 * east2;
  const double across = std::abs(north1 * east2 - east1 * north2);
  return along > 1e-9 * lengths ? across / along : std::numeric_limits<double>::infinity();
}

std::vector<Position> turn_arc(const Position& a, const Position& b, const Position& c,
                               double radius_m) {
  constexpr double kStep = 0.5 * std::numbers::pi / 180;
  const double share = tangent_share(on_map(a), on_map(b), on_map(c));
  if (radius_m == 0 || share == 0 || !std::isfinite(share)) return {};
  const double turn = 2 * std::atan(share);
  const Position begin = between(b, a, radius_m * share / distance_m(on_map(a), on_map(b)));
  const Position end = between(b, c, radius_m * share / distance_m(on_map(b), on_map(c)));
  const int half = static_cast<int>(std::ceil(turn / 2 / kStep));
  // A point that has turned by an angle since an end lies (1 - cos(angle)) / (1 - cos(turn)) of the
  // other end's tangent from the corner, besides the like along its own.
  const auto along = [&](int steps) {
    const double ratio = std::sin(turn * steps / half / 4) / std::sin(turn / 2);
    return ratio * ratio;
  };
  std::vector<Position> arc;
  for (int step = 0; step <= 2 * half; ++step) {
    Position point = step <= half ? between(begin, b, static_cast<double>(step) / half)
                                  : between(b, end, static_cast<double>(step) / half - 1);
    const double to_begin = along(2 * half - step);
    const double to_end = along(step);
    point.north_m =
        b.north_m + to_begin * (begin.north_m - b.north_m) + to_end * (end.north_m - b.north_m);
    point.east_m =
        b.east_m + to_begin * (begin.east_m - b.east_m) + to_end * (end.east_m - b.east_m);
    arc.push_back(point);
  }
  return arc;
}

}  // namespace skein::navigation
