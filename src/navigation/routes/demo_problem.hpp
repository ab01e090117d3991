#pragma once

#include "navigation/terrain/terrain.hpp"
#include "navigator.idl.hpp"

namespace skein::navigation {

/// A crossing of the terrain from south-west to north-east past four radar sites and three no-fly
/// zones, all placed and sized in proportion to the terrain; laid out for `synthetic:7`, and
/// flyable on real tiles too.
///
/// The aircraft flies 60 m/s with up to 30 degrees of bank (a turn radius of 636 m), keeps 120 m
/// above the ground, and pays 1 m of detour to save 1 m of exposure. The time limit is 0: the
/// caller sets it.
AE_navigator::Problem demo_problem(const Terrain& terrain);

/// The same, with the goal inside a ring of no-fly zones that is closed all around and reaches
/// beyond the highest altitude: no route exists, though the goal itself is free.
AE_navigator::Problem unreachable_demo_problem(const Terrain& terrain);

}  // namespace skein::navigation
