#include "navigation/routes/geojson.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "navigation/routes/earth_lines.hpp"
#include "navigation/routes/route_picture.hpp"
#include "navigation/terrain/plane_geometry.hpp"
#include "skein/error.hpp"

namespace skein::navigation {
namespace {

using AE_navigator::NoFlyZone;
using Json = nlohmann::ordered_json;

constexpr const char* kZoneKind = "no_fly_zone";

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

/// Reads zones; each value comes with its place in the text.
class ZoneReader {
 public:
  ZoneReader(const std::string& source, const Terrain& terrain)
      : source_(source), terrain_(terrain), frame_(frame_of(terrain)) {}

  std::vector<NoFlyZone> read(std::string_view text) {
    Json json;
    try {
      json = Json::parse(text);
    } catch (const Json::exception& error) {
      const std::string what = error.what();
      throw InvalidArgument(source_ + ": is no JSON: " + what.substr(what.find(']') + 2));
    }
    const std::string type = type_of(json, "");
    if (json.contains("crs")) {
      refuse("/crs",
             "GeoJSON has one coordinate reference system, WGS-84; transform the file to "
             "it and leave 'crs' out");
    }
    if (type == "Feature") {
      read_feature(json, "");
    } else if (type == "FeatureCollection") {
      const Json& features = array_in(json, "features", "");
      for (std::size_t i = 0; i < features.size(); ++i) {
        read_feature(features[i], fmt::format("/features/{}", i));
      }
    } else {
      refuse("/type", fmt::format("is '{}'; zones come as a FeatureCollection or a Feature", type));
    }
    return std::move(zones_);
  }

 private:
  [[noreturn]] void refuse(const std::string& place, const std::string& why) const {
    throw InvalidArgument(
        fmt::format("{}: {}: {}", source_, place.empty() ? "the whole" : place, why));
  }

  std::string type_of(const Json& json, const std::string& place) const {
    if (!json.is_object()) refuse(place, "is no JSON object");
    const auto type = json.find("type");
    if (type == json.end() || !type->is_string()) refuse(place, "has no 'type'");
    return type->get<std::string>();
  }

  const Json& array_in(const Json& json, const char* name, const std::string& place) const {
    const auto found = json.find(name);
    if (found == json.end() || !found->is_array()) {
      refuse(place, fmt::format("has no array '{}'", name));
    }
    return *found;
  }

  void read_feature(const Json& json, const std::string& place) {
    if (type_of(json, place) != "Feature") {
      refuse(place, fmt::format("is a '{}'; a Feature is expected", type_of(json, place)));
    }
    Json properties = json.contains("properties") ? json["properties"] : Json();
    if (properties.is_null()) properties = Json::object();
    if (!properties.is_object()) refuse(place + "/properties", "is no JSON object");
    if (properties.contains("kind") && properties["kind"] != kZoneKind) return;
    if (!json.contains("geometry") || json["geometry"].is_null()) {
      refuse(place, "has no geometry, so that it is no zone");
    }
    read_geometry(json["geometry"], properties, place);
  }

  void read_geometry(const Json& geometry, const Json& properties, const std::string& place) {
    const std::string shape = place + "/geometry";
    std::string type = type_of(geometry, shape);
    const bool several = type.starts_with("Multi");
    if (several) type.erase(0, 5);
    if (type != "Point" && type != "LineString" && type != "Polygon") {
      refuse(shape + "/type",
             fmt::format("is '{}'; a zone is a Polygon, a Point or a LineString with margin_m, or "
                         "several of these",
                         geometry["type"].get<std::string>()));
    }
    const Json& coordinates = array_in(geometry, "coordinates", shape);
    const NoFlyZone plain = without_outline(properties, type == "Polygon", place);
    for (std::size_t i = 0; i < (several ? coordinates.size() : 1); ++i) {
      const std::string part =
          several ? fmt::format("{}/coordinates/{}", shape, i) : shape + "/coordinates";
      NoFlyZone zone = plain;
      if (several) zone.name += fmt::format(" ({})", i + 1);
      zone.outline = outline(type, several ? coordinates[i] : coordinates, part);
      zones_.push_back(std::move(zone));
    }
  }

  NoFlyZone without_outline(const Json& properties, bool polygon, const std::string& place) const {
    NoFlyZone zone;
    const std::string at = place + "/properties";
    zone.name = fmt::format("zone {}", zones_.size() + 1);
    if (const auto name = properties.find("name"); name != properties.end() && !name->is_null()) {
      if (!name->is_string()) refuse(at + "/name", "is no text");
      zone.name = name->get<std::string>();
    }
    zone.margin_m = number(properties, "margin_m", 0, at);
    zone.floor_m = number(properties, "floor_m", -1000, at);
    zone.ceiling_m = number(properties, "ceiling_m", 20000, at);
    if (zone.margin_m < 0 || (!polygon && zone.margin_m == 0)) {
      refuse(at, fmt::format("margin_m is {} m; {}", zone.margin_m,
                             polygon ? "it must be 0 or more"
                                     : "a point or a line is a zone with a margin greater than 0"));
    }
    if (!(zone.floor_m < zone.ceiling_m)) {
      refuse(at, fmt::format("floor_m, {} m, is not below ceiling_m, {} m", zone.floor_m,
                             zone.ceiling_m));
    }
    return zone;
  }

  double number(const Json& properties, const char* name, double otherwise,
                const std::string& place) const {
    const auto found = properties.find(name);
    if (found == properties.end() || found->is_null()) return otherwise;
    if (!found->is_number()) refuse(fmt::format("{}/{}", place, name), "is no number of metres");
    return found->get<double>();
  }

  std::vector<AE_navigator::GroundPoint> outline(const std::string& type, const Json& coordinates,
                                                 const std::string& place) const {
    if (type == "Point") return {to_ground(position(coordinates, place), place)};
    if (type == "Polygon") return ring(coordinates, place);
    // There and back: an outline is closed, a corridor is not.
    std::vector<AE_navigator::GroundPoint> line = edges(coordinates, 2, place);
    for (std::size_t i = line.size() - 1; i-- > 1;) line.push_back(line[i]);
    require_size(line, place);
    return line;
  }

  std::vector<AE_navigator::GroundPoint> ring(const Json& polygon, const std::string& place) const {
    if (!polygon.is_array() || polygon.empty()) refuse(place, "is no polygon: it has no ring");
    if (polygon.size() > 1) {
      refuse(place + "/1", "is a hole; a zone has none: divide it into zones without holes");
    }
    const std::string at = place + "/0";
    std::vector<AE_navigator::GroundPoint> corners = edges(polygon[0], 4, at);
    if (polygon[0].front() != polygon[0].back()) {
      refuse(at, fmt::format("is not closed: its last position must be its first, {}",
                             polygon[0].front().dump()));
    }
    corners.pop_back();
    require_size(corners, at);
    require_simple(corners, at);
    return corners;
  }

  /// Straight in degrees, and so not quite straight in metres.
  std::vector<AE_navigator::GroundPoint> edges(const Json& line, std::size_t least,
                                               const std::string& place) const {
    if (!line.is_array() || line.size() < least) {
      refuse(place, fmt::format("has fewer than {} positions", least));
    }
    std::vector<AE_navigator::GroundPoint> points;
    EarthPlace before;
    for (std::size_t i = 0; i < line.size(); ++i) {
      const std::string at = fmt::format("{}/{}", place, i);
      const EarthPlace here = position(line[i], at);
      const auto point = to_ground(here, at);
      if (!points.empty()) {
        if (std::abs(here.longitude_deg - before.longitude_deg) > 180) {
          refuse(at,
                 "is reached around the whole earth: cut the outline at the antimeridian, as RFC "
                 "7946 wants it (section 3.1.9)");
        }
        const int pieces = static_cast<int>(std::ceil(distance_m(points.back(), point) / 2000));
        for (int piece = 1; piece < pieces; ++piece) {
          const double share = static_cast<double>(piece) / pieces;
          points.push_back(
              frame_.to_ground({std::lerp(before.latitude_deg, here.latitude_deg, share),
                                std::lerp(before.longitude_deg, here.longitude_deg, share)}));
        }
      }
      points.push_back(point);
      before = here;
    }
    return points;
  }

  EarthPlace position(const Json& json, const std::string& place) const {
    if (!json.is_array() || json.size() < 2 || !json[0].is_number() || !json[1].is_number()) {
      refuse(place, "is no position: a longitude and a latitude in degrees");
    }
    const EarthPlace there{json[1].get<double>(), json[0].get<double>()};
    if (!(std::abs(there.latitude_deg) <= 90)) {
      refuse(place,
             fmt::format("has latitude {}; GeoJSON has the longitude first, then the latitude",
                         there.latitude_deg));
    }
    if (!(std::abs(there.longitude_deg) <= 180)) {
      refuse(place,
             fmt::format("has longitude {}; longitudes are -180 to 180", there.longitude_deg));
    }
    return there;
  }

  AE_navigator::GroundPoint to_ground(const EarthPlace& earth, const std::string& place) const {
    const auto point = frame_.to_ground(earth);
    const double away_m =
        distance_m(point, {terrain_.north_extent_m() / 2, terrain_.east_extent_m() / 2});
    if (!(away_m <= 1e6)) {
      refuse(place, fmt::format("lies {:.0f} km from the middle of terrain '{}'; GeoJSON has the "
                                "longitude first, then the latitude",
                                away_m / 1000, terrain_.name()));
    }
    return point;
  }

  void require_size(const std::vector<AE_navigator::GroundPoint>& corners,
                    const std::string& place) const {
    if (corners.size() <= 1000) return;
    refuse(place,
           fmt::format("makes {} corners, with one every 2 km of long edges; a zone has 1000 "
                       "at most",
                       corners.size()));
  }

  void require_simple(const std::vector<AE_navigator::GroundPoint>& corners,
                      const std::string& place) const {
    const std::size_t count = corners.size();
    for (std::size_t i = 0; i < count; ++i) {
      for (std::size_t j = i + 2; j < count; ++j) {
        if (i == 0 && j == count - 1) continue;
        const auto& a = corners[i];
        const auto& c = corners[j];
        if (distance_m(a, corners[i + 1], c, corners[(j + 1) % count]) > 0) continue;
        const EarthPlace where = frame_.to_earth(c);
        refuse(place,
               fmt::format("crosses or touches itself near latitude {:.5f}, longitude {:.5f}",
                           where.latitude_deg, where.longitude_deg));
      }
    }
  }

  const std::string& source_;
  const Terrain& terrain_;
  const EarthFrame& frame_;
  std::vector<NoFlyZone> zones_;
};

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

std::vector<NoFlyZone> zones_from_geojson(std::string_view text, const std::string& source,
                                          const Terrain& terrain) {
  return ZoneReader(source, terrain).read(text);
}

}  // namespace skein::navigation
