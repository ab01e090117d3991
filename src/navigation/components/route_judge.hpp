#pragma once

#include <memory>
#include <optional>
#include <string>

#include "navigator.idl.hpp"
#include "skein/navigation/terrain.hpp"

namespace skein::navigation {

/// The navigator's judgement of a route that a CSP hands in: nothing if it may be passed on, else
/// what is wrong with it. It looks at what would cost the aircraft: every number is finite, the
/// route leads from the start to the goal over the terrain, and every edge keeps clear of the zones
/// and the ground and within the altitude and climb that the aircraft can fly. Some milliseconds at
/// most, so that it fits into the shortest request; turns and the claimed exposure are left to the
/// route checker.
std::optional<std::string> judge_route(const Terrain& terrain, const AE_navigator::Problem& problem,
                                       const AE_navigator::Route& route);

}  // namespace skein::navigation
