#pragma once

#include "navigation/terrain/terrain.hpp"
#include "navigator.idl.hpp"

namespace skein::navigation {

/// Throws InvalidProblem for a Problem that breaks a rule of `navigator.idl`, or that no route
/// could solve because its start or goal itself is off the terrain, too low, too high or inside a
/// zone.
void require_valid(const AE_navigator::Problem& problem, const Terrain& terrain);

/// Metres; infinitely tight turns, 0, where the limits name no bank angle.
double turn_radius_m(const AE_flightControllerI::FlightLimits& limits);

/// Metres of climb per metre over ground.
double climb_slope(const AE_flightControllerI::FlightLimits& limits);

}  // namespace skein::navigation
