#pragma once

#include <span>

#include "navigation/routes/route_picture.hpp"
#include "navigation/routes/svg_text.hpp"

namespace skein::navigation {

inline constexpr double kProfileHeight = 136;

/// Draws an altitude profile for each route below each other: the ground, the flight, and a bar
/// that shows where it is seen by radars, over the distance flown in kilometres. All have the same
/// scales.
void add_profiles(Svg& svg, const Terrain& terrain, const AE_navigator::Problem& problem,
                  std::span<const PicturedRoute> routes, double left, double top, double width);

/// Whether all of its numbers can be drawn.
bool drawable(const AE_navigator::Route& route);

}  // namespace skein::navigation
