#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "navigation/route_checker/height_grid.hpp"
#include "navigator.idl.hpp"

namespace skein::navigation {

/// What a route must satisfy; each rule is one of the promises of `navigator.idl`.
enum class RouteRule {
  Finite,        ///< Every number is finite.
  Continuity,    ///< At least two waypoints, no edge without length.
  Start,         ///< The first waypoint is the start.
  Goal,          ///< The last waypoint is the goal.
  Terrain,       ///< Every waypoint is over the terrain.
  Zone,          ///< No edge and no turn's arc enters a no-fly zone.
  Ground,        ///< Every edge and every turn's arc keeps the minimum height above ground.
  Altitude,      ///< No waypoint is above the maximum altitude.
  Climb,         ///< No edge is steeper than the aircraft climbs.
  Turn,          ///< The turns fit between each other.
  Length,        ///< The claimed length is right.
  LowestHeight,  ///< The claimed lowest height above ground is right.
  Exposure,      ///< The claimed exposure is right, and within the cap.
  Missiles,      ///< The claimed number of expected kills is right.
};

std::string_view to_string(RouteRule rule) noexcept;

struct RouteViolation {
  RouteRule rule;
  std::string text;  ///< Names the waypoint or edge (counted from 0), the figure and the limit.
};

/// How much claims and limits may be missed by before it counts.
struct RouteTolerances {
  double position_m = 0.01;
  double height_m = 0.1;
  double angle_deg = 0.01;
  double length_m = 0.5;
  double exposure_share =
      0.05;  ///< Of the exposure found here: shadow edges are found by sampling.
  double exposure_m = 50;
  double kills_share = 0.05;  ///< Of the expected kills found here, likewise.
  double kills = 0.02;
};

/// Checks a route against the problem that it should solve and the ground; empty means that it is
/// valid. All violations are reported, not only the first; where a number is not finite, of the
/// route or of the problem's zones and sites, nothing further is looked at. Throws InvalidArgument
/// for a grid that does not hold together.
///
/// It trusts nobody: it has its own ground, geometry and integration, and shares nothing with the
/// planners but the types of the IDL. Ground and zones are checked exactly, edge by edge, not by
/// sampling; so are turns, each as the arc of the least radius that touches both edges, to
/// `position_m`. Half way round a turn the aircraft is at its waypoint's altitude, before and after
/// it climbs as along the edges.
std::vector<RouteViolation> check_route(const AE_navigator::Problem& problem,
                                        const AE_navigator::Route& route, const HeightGrid& ground,
                                        const RouteTolerances& tolerances = {});

}  // namespace skein::navigation
