#include <fmt/core.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <nlohmann/json.hpp>

#include "navigation/routes/earth_lines.hpp"
#include "navigation/routes/geojson.hpp"
#include "navigation/terrain/plane_geometry.hpp"
#include "skein/error.hpp"

namespace skein::navigation {
namespace {

using AE_navigator::NoFlyZone;
using Json = nlohmann::ordered_json;

/// Of the names that GDAL, QGIS, GeoServer and others write.
bool is_wgs84(std::string name) {
  std::ranges::transform(name, name.begin(), [](unsigned char c) { return std::toupper(c); });
  for (char& c : name) {
    if (c == '/') c = ':';
  }
  const bool of_ogc = name.find("OGC:") != std::string::npos;
  const bool of_epsg = name.find("EPSG:") != std::string::npos;
  const std::string code = name.substr(name.rfind(':') + 1);
  return (of_ogc && (code == "CRS84" || code == "CRS84H")) ||
         (of_epsg && (code == "4326" || code == "4979")) || name == "CRS84";
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
    if (json.contains("crs")) require_wgs84(json["crs"], place + "/crs");
    return type->get<std::string>();
  }

  /// RFC 7946 knows no 'crs'; QGIS and ogr2ogr write it as the version of 2008 has it.
  void require_wgs84(const Json& crs, const std::string& place) const {
    if (crs.is_null()) return;
    const auto properties = crs.find("properties");
    const auto name = [&](const char* key) {
      return properties == crs.end() || !properties->is_object() ? Json()
                                                                 : properties->value(key, Json());
    };
    if (name("code") == 4326 || (name("name").is_string() && is_wgs84(name("name")))) return;
    refuse(place, fmt::format("{}; zones are read in WGS-84 alone, with the longitude first: "
                              "transform the file to it, as by ogr2ogr -t_srs EPSG:4326",
                              name("name").is_string() ? "is " + name("name").dump()
                                                       : "names no reference system"));
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
    if (several && coordinates.empty()) refuse(shape, "has no parts, so that it is no zone");
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
    require_inside(polygon[0], at);
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
        const double length_m = distance_m(points.back(), point);
        if (length_m == 0) continue;
        const int pieces = static_cast<int>(std::ceil(length_m / 2000));
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

  /// A square centimetre at least; of a ring that crosses itself no part weighs against another.
  void require_inside(const Json& ring, const std::string& place) const {
    const auto offset = [&](std::size_t i, int axis) {
      return ring[i][axis].get<double>() - ring[0][axis].get<double>();
    };
    double area = 0;
    for (std::size_t i = 0; i + 1 < ring.size(); ++i) {
      area += std::abs(offset(i, 0) * offset(i + 1, 1) - offset(i + 1, 0) * offset(i, 1));
    }
    if (area > 2e-14) return;
    refuse(
        place,
        "encloses nothing, so that it is no zone; a zone about a place or a line is a Point or a "
        "LineString with margin_m");
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

std::vector<NoFlyZone> zones_from_geojson(std::string_view text, const std::string& source,
                                          const Terrain& terrain) {
  return ZoneReader(source, terrain).read(text);
}

}  // namespace skein::navigation
