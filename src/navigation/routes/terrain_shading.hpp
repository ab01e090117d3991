#pragma once

#include "navigation/routes/png_image.hpp"
#include "navigation/terrain/terrain.hpp"
#include "navigator.idl.hpp"

namespace skein::navigation {

/// The terrain as a map: coloured by height, shaded by a sun in the north-west, and tinted where
/// the radar sites of the problem see an aircraft at its minimum height above ground.
Image shade(const Terrain& terrain, const AE_navigator::Problem& problem, int width, int height);

/// The colour of a height, from the lowlands of a terrain to its summits.
Colour height_colour(double share);

/// How strongly an exposure rate is tinted, 0 to 1: from a twentieth of a radar's strength upwards,
/// by the logarithm.
double tint(double exposure_rate);

inline constexpr Colour kExposureColour{0.78, 0.05, 0.22};

}  // namespace skein::navigation
