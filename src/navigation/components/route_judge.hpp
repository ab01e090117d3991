#pragma once

#include <functional>

#include "navigation/terrain/terrain.hpp"
#include "navigator.idl.hpp"
#include "skein/evaluation.hpp"

namespace skein::navigation {

/// The navigator's judgement of a route that a CSP hands in, check by check: `finite` numbers,
/// `start and goal`, `terrain`, `no-fly zone`, `height above ground`, `altitude`, `climb`, `turn
/// radius`, `turn` (zones and ground where turns fly inside of their waypoints), `exposure cap` and
/// `threat epoch`. Zones are the exact ones of the problem, around all of which the route must
/// stay; the exposure is computed here, where there is a cap, not taken from the route. A planner
/// whose routes miss the cap or the epoch works as it should: neither is held against it. Some
/// milliseconds at most, so that it fits into the shortest request; what else the route claims is
/// left to the route checker.
///
/// `epoch` tells the newest threat epoch that is known, when a route is judged; a problem whose own
/// epoch is 0 is not asked for it. Terrain and problem must outlive the result.
Evaluation<AE_navigator::Route> judgement(const Terrain& terrain,
                                          const AE_navigator::Problem& problem,
                                          std::function<std::uint32_t()> epoch);

}  // namespace skein::navigation
