#pragma once

#include <span>
#include <vector>

#include "navigation/threats/terrain_mask.hpp"
#include "navigator.idl.hpp"

namespace skein::navigation {

/// How much the radar sites of a Problem see of an aircraft.
///
/// The rate at a point is the sum over the sites that see it of strength * (range / r)^4, with r no
/// less than a quarter of the range (inverse fourth power as in Zabarankin, Uryasev and Murphey,
/// "Aircraft routing under the risk of detection", 2006); the exposure of an edge is the rate's
/// integral along it. Const members may be called from any thread. The terrain must outlive it.
class RadarExposure {
 public:
  RadarExposure(const Terrain& terrain, std::span<const AE_navigator::RadarSite> sites);

  /// Metres of exposure per metre flown.
  double rate(const AE_navigator::Position& point) const;

  /// Exposure of the straight edge in metres, by Simpson's rule on pieces of 40 m within two ranges
  /// of a site, where the edges of shadows matter, and of 200 m elsewhere.
  double along(const AE_navigator::Position& a, const AE_navigator::Position& b) const;

  /// Exposure of all edges of a route.
  double along(std::span<const AE_navigator::Position> waypoints) const;

 private:
  struct Antenna {
    AE_navigator::Position position;
    double range_m;
    double strength;
  };
  double rate(const Antenna& antenna, const AE_navigator::Position& point) const;
  double along(const Antenna& antenna, const AE_navigator::Position& a,
               const AE_navigator::Position& b) const;

  TerrainMask mask_;
  std::vector<Antenna> antennas_;
};

/// The rate of a site of that range and strength at a slant range of `distance_m` in plain view.
double exposure_rate(double range_m, double strength, double distance_m);

}  // namespace skein::navigation
