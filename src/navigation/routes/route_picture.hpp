#pragma once

#include <filesystem>
#include <span>
#include <string>

#include "navigation/terrain/terrain.hpp"
#include "navigator.idl.hpp"

namespace skein::navigation {

struct PicturedRoute {
  std::string label;  ///< For the legend, such as "AStar, 2 s to think".
  AE_navigator::Route route;
};

/// Draws routes over the shaded terrain as one SVG that refers to nothing outside of itself, below
/// 2 MB for any terrain: zones, radar and missile sites with the rings of their range, what radars
/// see at the minimum height above ground, start and goal, scale, north arrow, a legend with
/// length, exposure and lowest height, and one altitude profile per route. A route with a number
/// that is not finite is listed in the legend, but not drawn.
std::string route_picture(const Terrain& terrain, const AE_navigator::Problem& problem,
                          std::span<const PicturedRoute> routes, const std::string& title);

/// Writes such a picture. Throws InvalidArgument where the file cannot be made, Unavailable where
/// it cannot be written.
void write_route_picture(const std::filesystem::path& file, const Terrain& terrain,
                         const AE_navigator::Problem& problem,
                         std::span<const PicturedRoute> routes, const std::string& title);

/// Throws InvalidArgument where such a file cannot be made; for those who will write it later.
void try_route_picture(const std::filesystem::path& file);

}  // namespace skein::navigation
