#include "navigation/threats/radar_exposure.hpp"

#include <algorithm>
#include <cmath>

#include "navigation/terrain/plane_geometry.hpp"

namespace skein::navigation {
namespace {

/// Within this many ranges of a site its shadows matter: rays are followed exactly, not post by
/// post.
constexpr double kNear = 2;

constexpr double kFarStep_m = 200;
constexpr double kNearStep_m = 40;

}  // namespace

double exposure_rate(double range_m, double strength, double distance_m) {
  const double ratio = range_m / std::max(distance_m, range_m / 4);
  return strength * ratio * ratio * ratio * ratio;
}

RadarExposure::RadarExposure(const Terrain& terrain, std::span<const AE_navigator::RadarSite> sites)
    : mask_(terrain) {
  for (const auto& site : sites) {
    antennas_.push_back(
        {mast_top(terrain, site.site, site.mast_height_m), site.range_m, site.strength});
  }
}

double RadarExposure::rate(const Antenna& antenna, const Position& point) const {
  if (!mask_.sees(antenna.position, point, kNear * antenna.range_m)) return 0;
  return exposure_rate(antenna.range_m, antenna.strength, slant_range_m(antenna.position, point));
}

double RadarExposure::rate(const Position& point) const {
  double sum = 0;
  for (const Antenna& antenna : antennas_) sum += rate(antenna, point);
  return sum;
}

double RadarExposure::along(const Antenna& antenna, const Position& a, const Position& b) const {
  const double length = slant_range_m(a, b);
  const double nearest = distance_m(on_map(antenna.position), on_map(a), on_map(b));
  const double step = nearest < kNear * antenna.range_m ? kNearStep_m : kFarStep_m;
  const int pieces = std::max(1, static_cast<int>(std::ceil(length / step)));
  double sum = rate(antenna, a) + rate(antenna, b);
  for (int i = 1; i < 2 * pieces; ++i) {
    sum += (i % 2 == 1 ? 4 : 2) * rate(antenna, between(a, b, i / (2.0 * pieces)));
  }
  return sum * length / (6 * pieces);
}

double RadarExposure::along(const Position& a, const Position& b) const {
  double sum = 0;
  for (const Antenna& antenna : antennas_) sum += along(antenna, a, b);
  return sum;
}

double RadarExposure::along(std::span<const Position> waypoints) const {
  double sum = 0;
  for (std::size_t i = 1; i < waypoints.size(); ++i) sum += along(waypoints[i - 1], waypoints[i]);
  return sum;
}

}  // namespace skein::navigation
