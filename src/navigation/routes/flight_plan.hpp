#pragma once

#include <string>
#include <vector>

#include "navigation/terrain/terrain.hpp"
#include "navigator.idl.hpp"

namespace skein::navigation {

struct FlightPlan {
  std::string text;  ///< What a `.plan` file of QGroundControl holds.
  /// Zones that are not in its fence: the route passes over or below them, and a fence has no
  /// heights, so that the autopilot would turn away from its own route.
  std::vector<std::string> zones_left_out;
};

/// A route and its no-fly zones as QGroundControl's Plan File Format, version 1
/// (docs.qgroundcontrol.com, Plan File Format): each waypoint is a MAV_CMD_NAV_WAYPOINT at its
/// altitude above mean sea level, each zone an exclusion of the fence. A zone with a margin is put
/// together from its polygon, a circle about each corner and a rectangle along each side, which
/// together are no smaller than the zone.
///
/// Home is the ground below the start. There is neither take-off nor landing in it: the route
/// begins and ends in the air. Throws InvalidArgument for a terrain that lies nowhere on the earth,
/// and a route with a number that is not finite or fewer than two waypoints.
FlightPlan to_flight_plan(const Terrain& terrain, const AE_navigator::Problem& problem,
                          const AE_navigator::Route& route);

}  // namespace skein::navigation
