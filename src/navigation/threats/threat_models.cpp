#include "navigation/threats/threat_models.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>

#include "navigation/terrain/plane_geometry.hpp"
#include "skein/error.hpp"

namespace skein::navigation {
namespace {

constexpr double kStep_m = 40;

/// The part of a-b within a sphere, as shares of the way; the first not below the second where
/// there is none.
struct Part {
  double begin;
  double end;
};
Part within(const Position& middle, double radius_m, const Position& a, const Position& b) {
  const Position way{b.north_m - a.north_m, b.east_m - a.east_m, b.altitude_m - a.altitude_m};
  const Position to_a{a.north_m - middle.north_m, a.east_m - middle.east_m,
                      a.altitude_m - middle.altitude_m};
  const auto dot = [](const Position& p, const Position& q) {
    return p.north_m * q.north_m + p.east_m * q.east_m + p.altitude_m * q.altitude_m;
  };
  const double length2 = dot(way, way);
  if (length2 == 0) return {0, 0};
  const double nearest = -dot(to_a, way) / length2;
  const double half2 = nearest * nearest - (dot(to_a, to_a) - radius_m * radius_m) / length2;
  if (half2 <= 0) return {0, 0};
  return {std::max(0.0, nearest - std::sqrt(half2)), std::min(1.0, nearest + std::sqrt(half2))};
}

}  // namespace

MissileThreat::MissileThreat(const Terrain& terrain,
                             std::span<const AE_navigator::MissileSite> sites)
    : mask_(terrain) {
  for (const auto& site : sites) {
    launchers_.push_back(
        {mast_top(terrain, site.site, site.mast_height_m), site.range_m, site.kills_per_second});
  }
}

bool MissileThreat::sees(const Launcher& launcher, const Position& point) const {
  return mask_.sees(launcher.position, point, launcher.range_m);
}

double MissileThreat::seconds_in_danger(const Launcher& launcher, const Position& a,
                                        const Position& b, double speed_m_s) const {
  const Part part = within(launcher.position, launcher.range_m, a, b);
  if (part.begin >= part.end) return 0;
  const double length = (part.end - part.begin) * slant_range_m(a, b);
  const int pieces = std::max(1, static_cast<int>(std::ceil(length / kStep_m)));
  int seen = 0;
  for (int look = 0; look < 3 * pieces; ++look) {
    const double share = (look + 0.5) / (3 * pieces);
    seen += sees(launcher, between(a, b, part.begin + share * (part.end - part.begin))) ? 1 : 0;
  }
  return length * seen / (3 * pieces) / speed_m_s;
}

double MissileThreat::expected_kills(std::span<const Position> waypoints, double speed_m_s) const {
  if (!(speed_m_s > 0)) {
    throw InvalidArgument(fmt::format("the speed is {} m/s; it must be greater than 0", speed_m_s));
  }
  double sum = 0;
  for (const Launcher& launcher : launchers_) {
    for (std::size_t i = 1; i < waypoints.size(); ++i) {
      sum += launcher.kills_per_second *
             seconds_in_danger(launcher, waypoints[i - 1], waypoints[i], speed_m_s);
    }
  }
  return sum;
}

}  // namespace skein::navigation
