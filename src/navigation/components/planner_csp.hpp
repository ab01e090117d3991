#pragma once

#include <memory>
#include <string>

#include "navigation/terrain/terrain_provider.hpp"
#include "skein/detail/operation.hpp"
#include "skein/parameters.hpp"

namespace skein::navigation {

/// One of the planners that make_planner() knows, wrapped to be a CSP: `Time limit` (a duration) is
/// the most time that it takes for a route whatever the Problem allows, `Seed` the start of its
/// random numbers, `Exposure cap` the most exposure of CappedAStar's routes. It stops as soon as
/// nobody waits for its answer any more.
std::shared_ptr<Servant> make_planner_csp(const std::string& planner,
                                          std::shared_ptr<TerrainProvider> terrains,
                                          const ParameterValues& values);

}  // namespace skein::navigation
