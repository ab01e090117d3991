#include "navigation/routes/flight_plan.hpp"

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "navigation/routes/earth_lines.hpp"
#include "navigation/terrain/plane_geometry.hpp"
#include "navigation/threats/keep_out.hpp"
#include "skein/error.hpp"

namespace skein::navigation {
namespace {

using AE_navigator::NoFlyZone;
using Json = nlohmann::ordered_json;

constexpr int kPx4 = 12;          // MAV_AUTOPILOT_PX4
constexpr int kFixedWing = 1;     // MAV_TYPE_FIXED_WING
constexpr int kNavWaypoint = 16;  // MAV_CMD_NAV_WAYPOINT
constexpr int kGlobal = 0;        // MAV_FRAME_GLOBAL: above mean sea level
constexpr int kAbsolute = 2;      // QGroundControl's altitude mode for that

double rounded(double degrees) { return std::round(degrees * 1e7) / 1e7; }

/// Latitude before longitude, other than in GeoJSON.
Json place(const EarthFrame& frame, const GroundPoint& point) {
  const EarthPlace there = frame.to_earth(point);
  return Json::array({rounded(there.latitude_deg), rounded(there.longitude_deg)});
}

/// One polygon, or its parts on either side of the antimeridian: an autopilot compares longitudes
/// as plain numbers.
void add_polygon(Json& polygons, const EarthFrame& frame, const std::vector<GroundPoint>& corners) {
  for (EarthLine& ring : cut_outline(between_corners(frame, corners))) {
    ring.pop_back();
    if (ring.size() < 3) continue;
    Json outline = Json::array();
    for (const EarthPosition& corner : ring) {
      outline.push_back({rounded(corner.latitude_deg), rounded(corner.longitude_deg)});
    }
    polygons.push_back({{"inclusion", false}, {"polygon", std::move(outline)}, {"version", 1}});
  }
}

void fence_zone(Json& fence, const EarthFrame& frame, const NoFlyZone& zone) {
  const auto& corners = zone.outline;
  if (corners.size() > 2) add_polygon(fence["polygons"], frame, corners);
  if (!(zone.margin_m > 0)) return;
  // Wider by what a metre of the frame may differ from one of the earth, and by the rounding.
  const double margin_m = zone.margin_m * 1.0003 + 0.02;
  for (std::size_t i = 0; i < corners.size(); ++i) {
    fence["circles"].push_back(
        {{"circle", {{"center", place(frame, corners[i])}, {"radius", margin_m}}},
         {"inclusion", false},
         {"version", 1}});
    const GroundPoint& a = corners[i];
    const GroundPoint& b = corners[(i + 1) % corners.size()];
    const double length_m = distance_m(a, b);
    if (length_m == 0 || (corners.size() == 2 && i == 1)) continue;
    const double north_m = -(b.east_m - a.east_m) / length_m * margin_m;
    const double east_m = (b.north_m - a.north_m) / length_m * margin_m;
    add_polygon(fence["polygons"], frame,
                {{a.north_m + north_m, a.east_m + east_m},
                 {b.north_m + north_m, b.east_m + east_m},
                 {b.north_m - north_m, b.east_m - east_m},
                 {a.north_m - north_m, a.east_m - east_m}});
  }
}

bool is_passed_on_map(const NoFlyZone& zone, const AE_navigator::Route& route) {
  const KeepOut keep_out(zone, 0);
  for (std::size_t i = 1; i < route.waypoints.size(); ++i) {
    if (keep_out.crossed_on_map(on_map(route.waypoints[i - 1]), on_map(route.waypoints[i]))) {
      return true;
    }
  }
  return false;
}

Json waypoint(const EarthFrame& frame, const Position& position, int number) {
  const Json there = place(frame, on_map(position));
  const double altitude_m = std::round(position.altitude_m * 100) / 100;
  return {{"AMSLAltAboveTerrain", nullptr},
          {"Altitude", altitude_m},
          {"AltitudeMode", kAbsolute},
          {"autoContinue", true},
          {"command", kNavWaypoint},
          {"doJumpId", number},
          {"frame", kGlobal},
          {"params", Json::array({0, 0, 0, nullptr, there[0], there[1], altitude_m})},
          {"type", "SimpleItem"}};
}

}  // namespace

FlightPlan to_flight_plan(const Terrain& terrain, const AE_navigator::Problem& problem,
                          const AE_navigator::Route& route) {
  const EarthFrame& frame = frame_of(terrain);
  if (route.waypoints.size() < 2) {
    throw InvalidArgument("a route of fewer than two waypoints makes no flight plan");
  }
  FlightPlan plan;
  Json items = Json::array();
  for (const Position& position : route.waypoints) {
    if (!std::isfinite(position.north_m) || !std::isfinite(position.east_m) ||
        !std::isfinite(position.altitude_m)) {
      throw InvalidArgument("a route with a number that is not finite makes no flight plan");
    }
    items.push_back(waypoint(frame, position, static_cast<int>(items.size()) + 1));
  }
  Json fence{{"circles", Json::array()}, {"polygons", Json::array()}, {"version", 2}};
  for (const NoFlyZone& zone : problem.no_fly_zones) {
    if (is_passed_on_map(zone, route)) {
      plan.zones_left_out.push_back(zone.name);
    } else {
      fence_zone(fence, frame, zone);
    }
  }
  const GroundPoint start = on_map(route.waypoints.front());
  Json home = place(frame, start);
  home.push_back(std::round(terrain.height_m(start.north_m, start.east_m) * 100) / 100);
  plan.text = Json{{"fileType", "Plan"},
                   {"geoFence", std::move(fence)},
                   {"groundStation", "Skein"},
                   {"mission",
                    {{"cruiseSpeed", problem.limits.speed_m_s},
                     {"firmwareType", kPx4},
                     {"globalPlanAltitudeMode", kAbsolute},
                     {"hoverSpeed", problem.limits.speed_m_s},
                     {"items", std::move(items)},
                     {"plannedHomePosition", std::move(home)},
                     {"vehicleType", kFixedWing},
                     {"version", 2}}},
                   {"rallyPoints", {{"points", Json::array()}, {"version", 2}}},
                   {"version", 1}}
                  .dump(1) +
              "\n";
  return plan;
}

}  // namespace skein::navigation
