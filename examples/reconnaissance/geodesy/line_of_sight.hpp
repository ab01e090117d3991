#pragma once

#include <functional>

#include "geodesy/local_frame.hpp"

namespace reconnaissance {

/// The height of the ground above the geoid in metres, by place in the local frame.
using GroundHeight = std::function<double(double north_m, double east_m)>;

/// Refraction bends rays towards the ground: they are straight over an earth of so many times its
/// radius. For radio in the standard atmosphere 4/3 (Schelleng, Burrows and Ferrell, "Ultra-short
/// wave propagation", Proc. IRE 21, 1933).
inline constexpr double kRadioEarth = 4.0 / 3;
/// For light: Gauss's coefficient of refraction is 0.13 (Torge, "Geodesy", 2001).
inline constexpr double kOpticalEarth = 1 / (1 - 0.13);

/// How far the ground of a smooth earth is below the horizontal ray that left it `distance_m` ago.
double earth_drop_m(double distance_m, double earth_factor);

/// Whether no ground stands between two places: it is looked up each 50 m, half a post of SRTM.
/// The ends themselves are taken to be in the open.
bool in_sight(const Local& a, const Local& b, const GroundHeight& ground, double earth_factor);

}  // namespace reconnaissance
