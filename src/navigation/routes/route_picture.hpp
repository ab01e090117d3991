#pragma once

#include <span>
#include <string>

#include "navigation/terrain/terrain.hpp"
#include "navigator.idl.hpp"

namespace skein::navigation {

struct PicturedRoute {
  std::string label;  ///< For the legend, such as "AStar, 2 s to think".
  AE_navigator::Route route;
};

/// What a page needs to draw routes over a terrain, as JSON of at most 2 MB for any terrain, in
/// metres: heights of the ground, how much radars see at the minimum height above it, zones, radar
/// and missile sites, start and goal, and of each route its figures, `points` and `profile`. The
/// points of a route with a number that is not finite are null.
std::string route_picture(const Terrain& terrain, const AE_navigator::Problem& problem,
                          std::span<const PicturedRoute> routes, const std::string& title);

/// Whether all of its numbers can be drawn.
bool drawable(const AE_navigator::Route& route);

}  // namespace skein::navigation
