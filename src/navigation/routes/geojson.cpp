#include "navigation/routes/geojson.hpp"

#include <fmt/core.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "navigation/routes/earth_lines.hpp"
#include "navigation/routes/route_picture.hpp"

namespace skein::navigation {
namespace {

using AE_navigator::NoFlyZone;
using Json = nlohmann::ordered_json;

Json degrees(const EarthPosition& position) {
  const auto rounded = [](double value) { return std::round(value * 1e7) / 1e7; };
  return Json::array({rounded(position.longitude_deg), rounded(position.latitude_deg)});
}

Json degrees(const EarthLine& line) {
  Json list = Json::array();
  for (const EarthPosition& position : line) list.push_back(degrees(position));
  return list;
}

/// One part as it is, several as the type `Multi…`.
Json geometry(const std::string& type, std::vector<Json> parts) {
  if (parts.size() == 1) return {{"type", type}, {"coordinates", std::move(parts[0])}};
  return {{"type", "Multi" + type}, {"coordinates", std::move(parts)}};
}

Json feature(Json geometry, Json properties) {
  return {{"type", "Feature"},
          {"geometry", std::move(geometry)},
          {"properties", std::move(properties)}};
}

Json point(const EarthFrame& frame, const AE_navigator::GroundPoint& ground) {
  const EarthPlace place = frame.to_earth(ground);
  return {{"type", "Point"},
          {"coordinates", degrees(EarthPosition{place.longitude_deg, place.latitude_deg})}};
}

Json zone_feature(const EarthFrame& frame, const NoFlyZone& zone) {
  std::vector<AE_navigator::Position> corners;
  for (const auto& corner : zone.outline) corners.push_back({corner.north_m, corner.east_m, 0});
  Json shape;
  if (corners.size() == 1) {
    shape = point(frame, zone.outline[0]);
  } else {
    std::vector<Json> parts;
    if (corners.size() == 2) {
      for (const EarthLine& part : cut_line(along(frame, corners))) parts.push_back(degrees(part));
    } else {
      corners.push_back(corners.front());
      for (const EarthLine& ring : cut_outline(along(frame, corners))) {
        parts.push_back(Json::array({degrees(ring)}));
      }
    }
    shape = geometry(corners.size() == 2 ? "LineString" : "Polygon", std::move(parts));
  }
  return feature(std::move(shape), {{"kind", kZoneKind},
                                    {"name", zone.name},
                                    {"margin_m", zone.margin_m},
                                    {"floor_m", zone.floor_m},
                                    {"ceiling_m", zone.ceiling_m}});
}

Json route_feature(const EarthFrame& frame, const PicturedRoute& pictured) {
  const AE_navigator::Route& route = pictured.route;
  std::vector<Json> parts, altitudes;
  for (const EarthLine& part : cut_line(along(frame, route.waypoints))) {
    parts.push_back(degrees(part));
    altitudes.push_back(Json::array());
    for (const EarthPosition& position : part) {
      altitudes.back().push_back(std::round(position.altitude_m * 100) / 100);
    }
  }
  Json properties{{"kind", "route"},
                  {"name", pictured.label},
                  {"planner", route.planner},
                  {"length_m", route.length_m},
                  {"lowest_height_above_ground_m", route.lowest_height_above_ground_m},
                  {"radar_exposure_m", route.radar_exposure},
                  {"expected_kills", route.expected_kills}};
  properties["altitudes_m"] = altitudes.size() == 1 ? altitudes[0] : Json(altitudes);
  return feature(geometry("LineString", std::move(parts)), std::move(properties));
}

}  // namespace

std::string to_geojson(const Terrain& terrain, const AE_navigator::Problem& problem,
                       std::span<const PicturedRoute> routes) {
  const EarthFrame& frame = frame_of(terrain);
  Json features = Json::array();
  for (const NoFlyZone& zone : problem.no_fly_zones) features.push_back(zone_feature(frame, zone));
  for (const auto& radar : problem.radar_sites) {
    features.push_back(feature(point(frame, radar.site), {{"kind", "radar_site"},
                                                          {"name", radar.name},
                                                          {"mast_height_m", radar.mast_height_m},
                                                          {"range_m", radar.range_m},
                                                          {"strength", radar.strength}}));
  }
  for (const auto& missiles : problem.missile_sites) {
    features.push_back(
        feature(point(frame, missiles.site), {{"kind", "missile_site"},
                                              {"name", missiles.name},
                                              {"mast_height_m", missiles.mast_height_m},
                                              {"range_m", missiles.range_m},
                                              {"kills_per_second", missiles.kills_per_second}}));
  }
  for (const PicturedRoute& route : routes) {
    if (drawable(route.route)) features.push_back(route_feature(frame, route));
  }
  return Json{{"type", "FeatureCollection"}, {"features", std::move(features)}}.dump(1) + "\n";
}

}  // namespace skein::navigation
