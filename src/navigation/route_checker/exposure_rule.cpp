#include <algorithm>
#include <cmath>

#include "rules.hpp"

namespace skein::navigation::route_checker {
namespace {

using AE_navigator::Position;

/// Looks from the antenna to the aircraft in steps of a quarter of a post, and more closely at the
/// hill that the antenna stands on.
bool in_view(const HeightGrid& ground, const Position& antenna, const Position& aircraft) {
  constexpr double kTwiceEarth_m = 2 * 6371008.8 * 4 / 3;
  const double north = aircraft.north_m - antenna.north_m;
  const double east = aircraft.east_m - antenna.east_m;
  const double distance = std::hypot(north, east);
  const double step = std::min(ground.north_spacing_m, ground.east_spacing_m) / 4;
  // Over a curved earth, a ray at a share t of the way is lower than the straight line between the
  // two altitudes by t (1 - t) d^2 / 2R.
  const double bulge = distance * distance / kTwiceEarth_m;
  constexpr double kHill_m = 3000;
  for (double along = step / 5; along < distance; along += along < kHill_m ? step / 5 : step) {
    const double t = along / distance;
    const double ray =
        antenna.altitude_m + t * (aircraft.altitude_m - antenna.altitude_m) - t * (1 - t) * bulge;
    if (ground_height(ground, antenna.north_m + t * north, antenna.east_m + t * east) > ray) {
      return false;
    }
  }
  return true;
}

/// Visits the middles of the pieces that the edge is cut into, each with its length and its range
/// from the top of a mast, where that is in view.
template <class Visit>
void visit_in_view(const HeightGrid& ground, const AE_navigator::GroundPoint& site,
                   double mast_height_m, const Position& a, const Position& b, Visit visit) {
  constexpr double kStep_m = 20;
  const Position mast{site.north_m, site.east_m,
                      ground_height(ground, site.north_m, site.east_m) + mast_height_m};
  const double length =
      std::sqrt(std::pow(b.north_m - a.north_m, 2) + std::pow(b.east_m - a.east_m, 2) +
                std::pow(b.altitude_m - a.altitude_m, 2));
  const int pieces = static_cast<int>(length / kStep_m) + 1;
  for (int piece = 0; piece < pieces; ++piece) {
    const double t = (piece + 0.5) / pieces;
    const Position here{a.north_m + t * (b.north_m - a.north_m),
                        a.east_m + t * (b.east_m - a.east_m),
                        a.altitude_m + t * (b.altitude_m - a.altitude_m)};
    if (!in_view(ground, mast, here)) continue;
    visit(length / pieces, std::sqrt(std::pow(here.north_m - mast.north_m, 2) +
                                     std::pow(here.east_m - mast.east_m, 2) +
                                     std::pow(here.altitude_m - mast.altitude_m, 2)));
  }
}

}  // namespace

double exposure(const HeightGrid& ground, const AE_navigator::RadarSite& site, const Position& a,
                const Position& b) {
  double sum = 0;
  visit_in_view(ground, site.site, site.mast_height_m, a, b, [&](double length, double range) {
    sum +=
        length * site.strength * std::pow(site.range_m / std::max(range, 0.25 * site.range_m), 4);
  });
  return sum;
}

double metres_in_danger(const HeightGrid& ground, const AE_navigator::MissileSite& site,
                        const Position& a, const Position& b) {
  double sum = 0;
  visit_in_view(ground, site.site, site.mast_height_m, a, b, [&](double length, double range) {
    if (range < site.range_m) sum += length;
  });
  return sum;
}

}  // namespace skein::navigation::route_checker
