#pragma once

#include "navigator.idl.hpp"

namespace skein::navigation {

/// A place on the WGS-84 ellipsoid.
struct EarthPlace {
  double latitude_deg = 0;   ///< -90 to 90, north positive.
  double longitude_deg = 0;  ///< -180 to 180, east positive.
};

/// Where a terrain's flat frame lies on the earth: the azimuthal equidistant projection of WGS-84
/// about the terrain's middle (Snyder, Map Projections: A Working Manual, 1987, chapter 25; by
/// GeographicLib).
///
/// Distances and courses from the middle are true. Elsewhere a distance across the way to the
/// middle comes out too long by a share of r^2 / 6 R^2 at r metres from it: 2 parts in 100,000 at
/// the corner of a tile, 2 in 10,000 at the corner of three by three tiles at the equator.
class EarthFrame {
 public:
  /// `middle` is at `middle_point` in metres north and east of the terrain's south-west corner.
  EarthFrame(const EarthPlace& middle, const AE_navigator::GroundPoint& middle_point)
      : middle_(middle), middle_point_(middle_point) {}

  /// Metres north and east of the terrain's south-west corner; also for places beyond its edges.
  AE_navigator::GroundPoint to_ground(const EarthPlace& place) const;
  EarthPlace to_earth(const AE_navigator::GroundPoint& point) const;

 private:
  EarthPlace middle_;
  AE_navigator::GroundPoint middle_point_;
};

}  // namespace skein::navigation
