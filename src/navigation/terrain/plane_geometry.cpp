#include "navigation/terrain/plane_geometry.hpp"

#include <algorithm>
#include <cmath>

namespace skein::navigation {
namespace {

/// Twice the area of a, b, c: positive where c is on one side of a-b, negative on the other.
double side(const GroundPoint& a, const GroundPoint& b, const GroundPoint& c) {
  return (b.north_m - a.north_m) * (c.east_m - a.east_m) -
         (b.east_m - a.east_m) * (c.north_m - a.north_m);
}

bool properly_cross(const GroundPoint& a, const GroundPoint& b, const GroundPoint& c,
                    const GroundPoint& d) {
  return (side(a, b, c) > 0) != (side(a, b, d) > 0) && (side(c, d, a) > 0) != (side(c, d, b) > 0);
}

}  // namespace

double distance_m(const GroundPoint& a, const GroundPoint& b) {
  return std::hypot(a.north_m - b.north_m, a.east_m - b.east_m);
}

double slant_range_m(const Position& a, const Position& b) {
  return std::hypot(a.north_m - b.north_m, a.east_m - b.east_m, a.altitude_m - b.altitude_m);
}

double distance_m(const GroundPoint& point, const GroundPoint& a, const GroundPoint& b) {
  const double north = b.north_m - a.north_m;
  const double east = b.east_m - a.east_m;
  const double length2 = north * north + east * east;
  if (length2 == 0) return distance_m(point, a);
  const double share =
      ((point.north_m - a.north_m) * north + (point.east_m - a.east_m) * east) / length2;
  return distance_m(point, between(a, b, std::clamp(share, 0.0, 1.0)));
}

double distance_m(const GroundPoint& a, const GroundPoint& b, const GroundPoint& c,
                  const GroundPoint& d) {
  if (properly_cross(a, b, c, d)) return 0;
  return std::min(
      {distance_m(a, c, d), distance_m(b, c, d), distance_m(c, a, b), distance_m(d, a, b)});
}

}  // namespace skein::navigation
