#include "skein/navigation/radar_exposure.hpp"

#include <algorithm>
#include <cmath>

#include "plane_geometry.hpp"

namespace skein::navigation {
namespace {

double distance_3d_m(const Position& a, const Position& b) {
  return std::hypot(a.north_m - b.north_m, a.east_m - b.east_m, a.altitude_m - b.altitude_m);
}

}  // namespace

double exposure_rate(double range_m, double strength, double distance_m) {
  const double ratio = range_m / std::max(distance_m, range_m / 4);
  return strength * ratio * ratio * ratio * ratio;
}

double earth_drop_m(double distance_m) {
  constexpr double kEffectiveRadius_m = 6371008.8 * 4 / 3;
  return distance_m * distance_m / (2 * kEffectiveRadius_m);
}

RadarExposure::RadarExposure(const Terrain& terrain, std::span<const AE_navigator::RadarSite> sites)
    : terrain_(terrain) {
  for (const auto& site : sites) {
    const double ground = terrain.height_m(site.site.north_m, site.site.east_m);
    antennas_.push_back({{site.site.north_m, site.site.east_m, ground + site.mast_height_m},
                         site.range_m,
                         site.strength});
  }
}

bool RadarExposure::sees(const Antenna& antenna, const Position& point) const {
  const GroundPoint from = on_map(antenna.position);
  const GroundPoint to = on_map(point);
  const double distance = distance_m(from, to);
  const double step = std::min(terrain_.north_spacing_m(), terrain_.east_spacing_m());
  const int steps = static_cast<int>(distance / step);
  const double drop = earth_drop_m(distance);
  const double highest = terrain_.highest_m();
  // From the aircraft inwards: what hides it is mostly near it.
  for (int i = steps; i > 0; --i) {
    const double share = static_cast<double>(i) / (steps + 1);
    const double ray = std::lerp(antenna.position.altitude_m, point.altitude_m - drop, share) +
                       earth_drop_m(share * distance);
    if (ray > highest) continue;
    const GroundPoint below = between(from, to, share);
    if (terrain_.height_m(below.north_m, below.east_m) > ray) return false;
  }
  return true;
}

double RadarExposure::rate(const Position& point) const {
  double sum = 0;
  for (const Antenna& antenna : antennas_) {
    if (!sees(antenna, point)) continue;
    sum += exposure_rate(antenna.range_m, antenna.strength, distance_3d_m(antenna.position, point));
  }
  return sum;
}

double RadarExposure::along(const Position& a, const Position& b, double step_m) const {
  if (antennas_.empty()) return 0;
  const double length = distance_3d_m(a, b);
  const int pieces = std::max(1, static_cast<int>(std::ceil(length / step_m)));
  double sum = rate(a) + rate(b);
  for (int i = 1; i < 2 * pieces; ++i) {
    sum += (i % 2 == 1 ? 4 : 2) * rate(between(a, b, i / (2.0 * pieces)));
  }
  return sum * length / (6 * pieces);
}

double RadarExposure::along(std::span<const Position> waypoints) const {
  double sum = 0;
  for (std::size_t i = 1; i < waypoints.size(); ++i) sum += along(waypoints[i - 1], waypoints[i]);
  return sum;
}

}  // namespace skein::navigation
