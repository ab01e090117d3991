#pragma once

#include "navigator.idl.hpp"

// Distances on the map, and straight ones.
namespace skein::navigation {

using AE_navigator::GroundPoint;
using AE_navigator::Position;

inline GroundPoint on_map(const Position& position) { return {position.north_m, position.east_m}; }

double distance_m(const GroundPoint& a, const GroundPoint& b);

/// The straight way, altitudes counted.
double slant_range_m(const Position& a, const Position& b);

/// From a point to the nearest point of the segment a-b.
double distance_m(const GroundPoint& point, const GroundPoint& a, const GroundPoint& b);

/// Between the nearest points of the segments a-b and c-d; 0 where they cross or touch.
double distance_m(const GroundPoint& a, const GroundPoint& b, const GroundPoint& c,
                  const GroundPoint& d);

/// The point at `share` of the way from a to b.
inline GroundPoint between(const GroundPoint& a, const GroundPoint& b, double share) {
  return {a.north_m + share * (b.north_m - a.north_m), a.east_m + share * (b.east_m - a.east_m)};
}

inline Position between(const Position& a, const Position& b, double share) {
  return {a.north_m + share * (b.north_m - a.north_m), a.east_m + share * (b.east_m - a.east_m),
          a.altitude_m + share * (b.altitude_m - a.altitude_m)};
}

}  // namespace skein::navigation
