#include "geodesy/line_of_sight.hpp"

#include <cmath>

namespace reconnaissance {
namespace {

constexpr double kEarthRadius_m = 6371009;  // Mean radius of WGS-84.
constexpr double kStep_m = 50;

}  // namespace

double earth_drop_m(double distance_m, double earth_factor) {
  return distance_m * distance_m / (2 * earth_factor * kEarthRadius_m);
}

bool in_sight(const Local& a, const Local& b, const GroundHeight& ground, double earth_factor) {
  const double distance = map_distance_m(b, a);
  const double whole_drop = earth_drop_m(distance, earth_factor);
  const int steps = static_cast<int>(std::ceil(distance / kStep_m));
  for (int i = 1; i < steps; ++i) {
    const double share = static_cast<double>(i) / steps;
    // A chord of the earth is d1 d2 / 2kR below its arc.
    const double ray = std::lerp(a.height_m, b.height_m, share) - share * (1 - share) * whole_drop;
    if (ground(std::lerp(a.north_m, b.north_m, share), std::lerp(a.east_m, b.east_m, share)) >
        ray) {
      return false;
    }
  }
  return true;
}

}  // namespace reconnaissance
