#pragma once

#include <cmath>
#include <span>
#include <vector>

#include "navigation/terrain/terrain.hpp"
#include "navigator.idl.hpp"

// Lines of a terrain's frame as lines of longitude and latitude.
namespace skein::navigation {

/// A position in degrees with what belongs to it. Longitudes run on over the antimeridian, so that
/// neighbours are neighbours, until the line is cut there.
struct EarthPosition {
  double longitude_deg;
  double latitude_deg;
  double altitude_m = 0;
};

using EarthLine = std::vector<EarthPosition>;

/// The frame of a terrain. Throws InvalidArgument for one that lies nowhere on the earth.
const EarthFrame& frame_of(const Terrain& terrain);

/// The straight edges between these points, with a position every 2 km at most.
EarthLine along(const EarthFrame& frame, std::span<const AE_navigator::Position> points);

/// The corners alone.
EarthLine between_corners(const EarthFrame& frame,
                          std::span<const AE_navigator::GroundPoint> corners);

/// The line's parts on either side of the antimeridian, with longitudes from -180 to 180.
std::vector<EarthLine> cut_line(const EarthLine& line);

/// The parts of what a line encloses (its end is joined to its beginning) on either side of the
/// antimeridian, each against the clock, its last position equal to its first.
std::vector<EarthLine> cut_outline(EarthLine outline);

}  // namespace skein::navigation
