#pragma once

#include "navigator.idl.hpp"
#include "skein/detail/history.hpp"

namespace skein::navigation {

/// What of a problem may matter for the choice of a planner: the distance between
/// start and goal, how many zones and threats there are, what exposure is worth, and the time that
/// is left.
Features features_of(const AE_navigator::Problem& problem, Duration time);

/// How good a route is: the length of the straight line over what the route costs, which is its
/// length and what its exposure and expected kills are worth. 1: there can be none better.
double quality_of(const AE_navigator::Problem& problem, const AE_navigator::Route& route);

}  // namespace skein::navigation
