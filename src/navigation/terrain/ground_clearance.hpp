#pragma once

#include "navigation/terrain/terrain.hpp"
#include "navigator.idl.hpp"

namespace skein::navigation {

/// Where the straight edge from `a` to `b` comes closest to the ground.
struct GroundClearance {
  double lowest_m;  ///< Height above the ground there; negative below it.
  double at;        ///< Where, from 0 at `a` to 1 at `b`.
};

/// Exact on the bilinear surface: every cell that the edge crosses is looked at, and the ground
/// along a line within one cell is a parabola whose lowest clearance has a closed form.
GroundClearance ground_clearance(const Terrain& terrain, const AE_navigator::Position& a,
                                 const AE_navigator::Position& b);

}  // namespace skein::navigation
