#pragma once

#include <vector>

#include "navigation/terrain/plane_geometry.hpp"
#include "navigator.idl.hpp"

namespace skein::navigation {

/// How far before the corner `b` the turn from a-b to b-c begins, per metre of turn radius: the
/// tangent of half the change of heading. Infinite for a reversal.
double tangent_share(const GroundPoint& a, const GroundPoint& b, const GroundPoint& c);

/// The turn from a-b to b-c as it is flown: points on the arc of `radius_m` that touches both
/// edges, an odd number of them, at equal angles of half a degree at most. The middle one is at the
/// altitude of `b`; before and after it the aircraft climbs as along the edges. Empty for a
/// radius of 0, for a reversal, and where there is no turn. Whether there is room for it is not
/// looked at.
std::vector<AE_navigator::Position> turn_arc(const AE_navigator::Position& a,
                                             const AE_navigator::Position& b,
                                             const AE_navigator::Position& c, double radius_m);

}  // namespace skein::navigation
