#include "navigation/routes/geojson.hpp"

#include <catch2/catch.hpp>
#include <cmath>
#include <nlohmann/json.hpp>

#include "navigation/routes/flight_plan.hpp"
#include "navigation/terrain/plane_geometry.hpp"
#include "navigation/threats/keep_out.hpp"
#include "skein/error.hpp"
#include "test/navigation/made_geography.hpp"
#include "test/navigation/made_terrain.hpp"

using namespace skein::navigation;
using namespace skein::navigation::testing;
using AE_navigator::NoFlyZone;
using AE_navigator::Problem;
using Catch::Contains;
using Json = nlohmann::json;

namespace {

Json feature_named(const Json& collection, const std::string& name) {
  for (const Json& feature : collection["features"]) {
    if (feature["properties"]["name"] == name) return feature;
  }
  FAIL("no feature " << name);
  return {};
}

std::string refusal(const std::string& text, const Terrain& terrain) {
  try {
    zones_from_geojson(text, "zones.geojson", terrain);
  } catch (const skein::InvalidArgument& error) {
    return error.what();
  }
  return "accepted";
}

double area(const Json& ring) {
  double sum = 0;
  for (std::size_t i = 0; i + 1 < ring.size(); ++i) {
    sum += ring[i][0].get<double>() * ring[i + 1][1].get<double>() -
           ring[i + 1][0].get<double>() * ring[i][1].get<double>();
  }
  return sum / 2;
}

}  // namespace

TEST_CASE("In GeoJSON a place is its longitude, then its latitude") {
  const Terrain terrain = level(51.5, 6.5);
  const Json json = Json::parse(to_geojson(terrain, problem(), {}));
  CHECK(json["type"] == "FeatureCollection");
  const Json tower = feature_named(json, "Tower");
  const EarthPlace place = terrain.frame()->to_earth({20000, 30000});
  CHECK(tower["geometry"]["type"] == "Point");
  CHECK(tower["geometry"]["coordinates"][0].get<double>() ==
        Approx(place.longitude_deg).epsilon(0).margin(6e-8));
  CHECK(tower["geometry"]["coordinates"][1].get<double>() ==
        Approx(place.latitude_deg).epsilon(0).margin(6e-8));
  CHECK(tower["geometry"]["coordinates"].size() == 2);
  CHECK(tower["properties"]["margin_m"] == 2500);
  CHECK(feature_named(json, "Valley")["geometry"]["type"] == "LineString");
  CHECK(feature_named(json, "Alpha")["properties"]["kind"] == "radar_site");
  CHECK(feature_named(json, "Sierra")["properties"]["range_m"] == 4000);
}

TEST_CASE("An outline is closed and runs against the clock, whichever way the zone's corners run") {
  const Terrain terrain = level(51.5, 6.5);
  Problem made = problem();
  for (int i = 0; i < 2; ++i) {
    const Json json = Json::parse(to_geojson(terrain, made, {}));
    const Json town = feature_named(json, "Town");
    CHECK(town["geometry"]["type"] == "Polygon");
    REQUIRE(town["geometry"]["coordinates"].size() == 1);
    const Json& ring = town["geometry"]["coordinates"][0];
    CHECK(ring.front() == ring.back());
    CHECK(area(ring) > 0);
    std::ranges::reverse(made.no_fly_zones[2].outline);
  }
}

TEST_CASE("A route in GeoJSON follows its straight edges to a metre, and has its altitudes") {
  const Terrain terrain = level(51.5, 6.5);
  const std::vector<PicturedRoute> routes{route()};
  const Json json = Json::parse(to_geojson(terrain, problem(), routes));
  const Json feature = feature_named(json, "first");
  const Json& line = feature["geometry"]["coordinates"];
  const Json& altitudes = feature["properties"]["altitudes_m"];
  REQUIRE(line.size() == altitudes.size());
  CHECK(altitudes.front() == 300);
  CHECK(altitudes.back() == 450.5);
  const auto& points = routes[0].route.waypoints;
  for (std::size_t i = 1; i < line.size(); ++i) {
    for (const double share : {0.0, 0.5}) {
      const auto point = terrain.frame()->to_ground(
          {std::lerp(line[i - 1][1].get<double>(), line[i][1].get<double>(), share),
           std::lerp(line[i - 1][0].get<double>(), line[i][0].get<double>(), share)});
      CHECK(std::min(distance_m(point, on_map(points[0]), on_map(points[1])),
                     distance_m(point, on_map(points[1]), on_map(points[2]))) < 1);
    }
  }
}

TEST_CASE("Zones come back from GeoJSON as they were, and what is no zone is passed over") {
  const Terrain terrain = level(51.5, 6.5);
  const Problem made = problem();
  const std::vector<PicturedRoute> routes{route()};
  const std::vector<NoFlyZone> read =
      zones_from_geojson(to_geojson(terrain, made, routes), "zones.geojson", terrain);
  REQUIRE(read.size() == 3);
  for (std::size_t i = 0; i < 3; ++i) {
    const NoFlyZone& zone = made.no_fly_zones[i];
    CHECK(read[i].name == zone.name);
    CHECK(read[i].margin_m == zone.margin_m);
    CHECK(read[i].floor_m == zone.floor_m);
    CHECK(read[i].ceiling_m == zone.ceiling_m);
    const KeepOut before(zone, 0), after(read[i], 0);
    for (double north = 1000; north < 111000; north += 7000) {
      for (double east = 500; east < 70000; east += 5000) {
        CHECK(after.distance_m({north, east}) ==
              Approx(before.distance_m({north, east})).margin(0.5));
      }
    }
  }
}

TEST_CASE("What crosses the antimeridian is cut there, whole and on the right side") {
  const Terrain terrain = level(-17.5, 179.9);
  Problem made = problem();
  made.no_fly_zones = {forked_zone(), {"Line", {{60000, 20000}, {60000, 65000}}, 500, 0, 1000}};
  const std::vector<PicturedRoute> routes{route()};
  const Json json = Json::parse(to_geojson(terrain, made, routes));
  const Json fork = feature_named(json, "Fork");
  REQUIRE(fork["geometry"]["type"] == "MultiPolygon");
  CHECK(fork["geometry"]["coordinates"].size() == 3);
  double sum_km2 = 0;
  for (const Json& polygon : fork["geometry"]["coordinates"]) {
    const Json& ring = polygon[0];
    CHECK(ring.front() == ring.back());
    CHECK(area(ring) > 0);
    double west = 180, east = -180;
    for (const Json& position : ring) {
      west = std::min(west, position[0].get<double>());
      east = std::max(east, position[0].get<double>());
    }
    CHECK((east == 180 || west == -180));
    CHECK(east - west < 1);
    sum_km2 += area(ring) * 110.66 * 111.32 * std::cos(17.7 * 0.017453292519943295);
  }
  CHECK(sum_km2 == Approx(720).epsilon(0.01));
  CHECK(feature_named(json, "Line")["geometry"]["type"] == "MultiLineString");
  const Json line = feature_named(json, "first");
  CHECK(line["geometry"]["type"] == "MultiLineString");
  CHECK(line["geometry"]["coordinates"][0].back()[0] == 180);
  CHECK(line["geometry"]["coordinates"][1].front()[0] == -180);
  REQUIRE(line["properties"]["altitudes_m"].size() == 2);
  CHECK(line["properties"]["altitudes_m"][1].size() == line["geometry"]["coordinates"][1].size());
  // And they come back: three polygons and two lines, which are zones of their own.
  const auto read = zones_from_geojson(json.dump(), "zones.geojson", terrain);
  REQUIRE(read.size() == 5);
  const auto is_closed = [&](double north_m, double east_m) {
    return std::any_of(read.begin(), read.end(), [&](const NoFlyZone& zone) {
      return KeepOut(zone, 0).contains({north_m, east_m, 500});
    });
  };
  CHECK(is_closed(15000, 35000));
  CHECK(is_closed(15000, 58000));
  CHECK(is_closed(35000, 61000));
  CHECK_FALSE(is_closed(25000, 50000));
  CHECK(is_closed(60300, 45000));
  CHECK_FALSE(is_closed(61000, 45000));
}

TEST_CASE("GeoJSON is read as QGIS and ogr2ogr write it") {
  const Terrain terrain = level(51.5, 6.5);
  const auto read = [&](const std::string& head, const std::string& ring) {
    return refusal(R"({"type": "FeatureCollection", "name": "zones", "bbox": [6, 51, 7, 52], )" +
                       head + R"("features": [{"type": "Feature", "id": 7, "bbox": [6, 51, 7, 52],
                       "properties": {"fid": 1, "name": null}, "geometry": {"type": "Polygon",
                       "coordinates": [[)" +
                       ring + "]]}}]}",
                   terrain);
  };
  const std::string triangle = "[6.4,51.4,0],[6.6,51.4,12.5],[6.6,51.6,0],[6.4,51.4,0]";
  const auto named = [&](const std::string& name) {
    return read(R"("crs": {"type": "name", "properties": {"name": ")" + name + "\"}}, ", triangle);
  };
  CHECK(read("", triangle) == "accepted");
  CHECK(read("\"crs\": null, ", triangle) == "accepted");
  for (const char* name :
       {"urn:ogc:def:crs:OGC:1.3:CRS84", "urn:ogc:def:crs:OGC::CRS84", "OGC:CRS84", "EPSG:4326",
        "urn:ogc:def:crs:EPSG::4326", "http://www.opengis.net/def/crs/OGC/1.3/CRS84"}) {
    CAPTURE(name);
    CHECK(named(name) == "accepted");
  }
  CHECK_THAT(named("urn:ogc:def:crs:EPSG::25832"),
             Contains("/crs: is \"urn:ogc:def:crs:EPSG::25832\"") && Contains("ogr2ogr -t_srs"));
  CHECK_THAT(named("urn:ogc:def:crs:EPSG::14326"), Contains("/crs: is "));
  CHECK_THAT(read(R"("crs": {"type": "link", "properties": {"href": "x"}}, )", triangle),
             Contains("/crs: names no reference system"));
  // ogr2ogr rounds to seven places, which makes neighbours one.
  CHECK(read("", "[6.4,51.4],[6.4,51.4],[6.6,51.4],[6.6,51.6],[6.6,51.6],[6.4,51.4],[6.4,51.4]") ==
        "accepted");
}

TEST_CASE("A zone that would protect nothing is refused") {
  const Terrain terrain = level(51.5, 6.5);
  const auto read = [&](const std::string& type, const std::string& coordinates) {
    return refusal(
        R"({"type": "Feature", "properties": {"margin_m": 500}, "geometry": {"type": ")" + type +
            R"(", "coordinates": )" + coordinates + "}}",
        terrain);
  };
  const auto is_nothing = Contains("/geometry/coordinates/0: encloses nothing");
  CHECK_THAT(read("Polygon", "[[[6.4,51.4],[6.4,51.4],[6.4,51.4],[6.4,51.4]]]"), is_nothing);
  CHECK_THAT(read("Polygon", "[[[6.4,51.4],[6.5,51.5],[6.6,51.6],[6.4,51.4]]]"), is_nothing);
  for (const char* type : {"MultiPolygon", "MultiLineString", "MultiPoint"}) {
    CHECK_THAT(read(type, "[]"), Contains("/geometry: has no parts"));
  }
  CHECK(read("LineString", "[[6.4,51.4],[6.4,51.4]]") == "accepted");
}

TEST_CASE("GeoJSON that is no zone is refused with its place and the reason") {
  const Terrain terrain = level(51.5, 6.5);
  const std::string good =
      R"({"type": "FeatureCollection", "features": [
        {"type": "Feature", "properties": null, "geometry":
          {"type": "Polygon", "coordinates": [[[6.4,51.4],[6.6,51.4],[6.6,51.6],[6.4,51.4]]]}}]})";
  const auto with = [&](const std::string& what, const std::string& instead) {
    std::string text = good;
    REQUIRE(text.find(what) != std::string::npos);
    return refusal(text.replace(text.find(what), what.size(), instead), terrain);
  };
  CHECK(refusal(good, terrain) == "accepted");
  const auto zones = zones_from_geojson(good, "zones.geojson", terrain);
  REQUIRE(zones.size() == 1);
  CHECK(zones[0].name == "zone 1");
  CHECK(zones[0].ceiling_m == 20000);

  CHECK_THAT(with("\"features\": [",
                  "\"features\": ["
                  "\n,"),
             Contains("line 2, column 1"));
  CHECK_THAT(with("FeatureCollection", "Topology"),
             Contains("zones.geojson: /type: is 'Topology'"));
  CHECK_THAT(with("\"Feature\",", "\"Polygon\","), Contains("/features/0: is a 'Polygon'"));
  CHECK_THAT(
      with("{\"type\": \"FeatureCollection\",", "{\"crs\": {}, \"type\": \"FeatureCollection\","),
      Contains("/crs: names no reference system") && Contains("WGS-84"));
  CHECK_THAT(with("\"properties\": null", "\"properties\": 7"),
             Contains("/features/0/properties: "));
  CHECK_THAT(with("\"properties\": null", "\"properties\": {\"floor_m\": \"low\"}"),
             Contains("/features/0/properties/floor_m: is no number"));
  CHECK_THAT(with("\"properties\": null", "\"properties\": {\"floor_m\": 30000}"),
             Contains("/features/0/properties: ") && Contains("not below ceiling_m"));
  CHECK_THAT(with("\"properties\": null", "\"properties\": {\"margin_m\": -1}"),
             Contains("margin_m is -1 m"));
  CHECK_THAT(with("\"Polygon\"", "\"GeometryCollection\""),
             Contains("/features/0/geometry/type: is 'GeometryCollection'"));
  CHECK_THAT(with("[6.6,51.4]", "[6.6,95]"),
             Contains("/features/0/geometry/coordinates/0/1: has latitude 95") &&
                 Contains("longitude first"));
  CHECK_THAT(with("[6.6,51.4]", "[51.4,6.6]"),
             Contains("/coordinates/0/1: lies") && Contains("longitude first"));
  CHECK_THAT(with("[6.6,51.4]", "[366.6,51.4]"), Contains("has longitude 366.6"));
  CHECK_THAT(with("[6.6,51.4]", "[6.6]"), Contains("/coordinates/0/1: is no position"));
  CHECK_THAT(with("[6.6,51.4]", "[6.6,\"x\"]"), Contains("/coordinates/0/1: is no position"));
  CHECK_THAT(with(",[6.4,51.4]]]", "]]"), Contains("fewer than 4 positions"));
  CHECK_THAT(
      with("[6.4,51.4]]]", "[6.4,51.5]]]"),
      Contains("/features/0/geometry/coordinates/0: is not closed") && Contains("[6.4,51.4]"));
  CHECK_THAT(with("[6.6,51.4],[6.6,51.6]", "[6.6,51.6],[6.6,51.4],[6.4,51.6]"),
             Contains("/coordinates/0: crosses or touches itself near latitude 51."));
  CHECK_THAT(with("]]]}", "]],[[6.5,51.45],[6.55,51.45],[6.55,51.5],[6.5,51.45]]]}"),
             Contains("/coordinates/1: is a hole"));
  const auto pointed = [&](const std::string& properties) {
    return refusal(R"({"type": "Feature", "properties": )" + properties +
                       R"(, "geometry": {"type": "Point", "coordinates": [6.5, 51.5]}})",
                   terrain);
  };
  CHECK(pointed(R"({"margin_m": 500})") == "accepted");
  CHECK_THAT(pointed("{}"), Contains("/properties: margin_m is 0 m"));
  CHECK_THAT(refusal(good, Terrain("synthetic:7", 2, 2, 1, 1, {0, 0, 0, 0})),
             Contains("'synthetic:7' is invented"));
  const Terrain fiji = level(-17.5, 179.9);
  CHECK_THAT(refusal(R"({"type": "Feature", "properties": null, "geometry": {"type": "Polygon",
                     "coordinates": [[[179.9,-17.5],[-179.9,-17.5],[-179.9,-17.4],[179.9,-17.5]]]}})",
                     fiji),
             Contains("/geometry/coordinates/0/1: is reached around the whole earth") &&
                 Contains("3.1.9"));
}

TEST_CASE("A flight plan has each waypoint at its place and its altitude above mean sea level") {
  const Terrain terrain = level(51.5, 6.5);
  const PicturedRoute made = route();
  const Json plan = Json::parse(to_flight_plan(terrain, problem(), made.route).text);
  CHECK(plan["fileType"] == "Plan");
  CHECK(plan["version"] == 1);
  CHECK(plan["mission"]["version"] == 2);
  CHECK(plan["mission"]["cruiseSpeed"] == 60);
  const Json& home = plan["mission"]["plannedHomePosition"];
  CHECK(home[2] == 100);
  const Json& items = plan["mission"]["items"];
  REQUIRE(items.size() == 3);
  for (std::size_t i = 0; i < 3; ++i) {
    const auto& point = made.route.waypoints[i];
    const EarthPlace place = terrain.frame()->to_earth(on_map(point));
    CHECK(items[i]["command"] == 16);
    CHECK(items[i]["frame"] == 0);
    CHECK(items[i]["doJumpId"] == i + 1);
    CHECK(items[i]["params"][4].get<double>() ==
          Approx(place.latitude_deg).epsilon(0).margin(6e-8));
    CHECK(items[i]["params"][5].get<double>() ==
          Approx(place.longitude_deg).epsilon(0).margin(6e-8));
    CHECK(items[i]["params"][6] == point.altitude_m);
    CHECK(items[i]["Altitude"] == point.altitude_m);
  }
  CHECK(home[0] == items[0]["params"][4]);
}

TEST_CASE("The fence of a flight plan holds all of a zone, its margin too") {
  const Terrain terrain = level(51.5, 6.5);
  const Problem made = problem();
  PicturedRoute away = route();
  away.route.waypoints = {{105000, 5000, 300}, {105000, 65000, 300}};
  const FlightPlan written = to_flight_plan(terrain, made, away.route);
  CHECK(written.zones_left_out.empty());
  const Json fence = Json::parse(written.text)["geoFence"];
  const auto ground = [&](const Json& place) {
    return terrain.frame()->to_ground({place[0].get<double>(), place[1].get<double>()});
  };
  std::vector<KeepOut> shapes;
  for (const Json& circle : fence["circles"]) {
    CHECK(circle["inclusion"] == false);
    shapes.emplace_back(NoFlyZone{"",
                                  {ground(circle["circle"]["center"])},
                                  circle["circle"]["radius"].get<double>(),
                                  -1,
                                  1},
                        0);
  }
  for (const Json& polygon : fence["polygons"]) {
    CHECK(polygon["inclusion"] == false);
    NoFlyZone shape{"", {}, 0, -1, 1};
    for (const Json& corner : polygon["polygon"]) shape.outline.push_back(ground(corner));
    shapes.emplace_back(shape, 0);
  }
  int inside = 0;
  for (const NoFlyZone& zone : made.no_fly_zones) {
    const KeepOut keep_out(zone, 0);
    for (double north = 0; north < 111000; north += 370) {
      for (double east = 0; east < 70000; east += 310) {
        if (keep_out.distance_m({north, east}) > 0) continue;
        ++inside;
        if (std::none_of(shapes.begin(), shapes.end(), [&](const KeepOut& shape) {
              return shape.distance_m({north, east}) == 0;
            })) {
          FAIL(zone.name << " at " << north << ", " << east << " is outside of the fence");
        }
      }
    }
  }
  CHECK(inside > 1000);
}

TEST_CASE("A zone that the route passes over is not in the fence, which has no heights") {
  const Terrain terrain = level(51.5, 6.5);
  PicturedRoute over = route();
  over.route.waypoints = {{20000, 5000, 2500}, {20000, 65000, 2500}};
  const FlightPlan plan = to_flight_plan(terrain, problem(), over.route);
  CHECK(plan.zones_left_out == std::vector<std::string>{"Tower"});
  CHECK(Json::parse(plan.text)["geoFence"]["circles"].size() == 6);
}

TEST_CASE("What lies nowhere on the earth makes no GeoJSON and no flight plan") {
  const Terrain invented("synthetic:7", 2, 2, 1000, 1000, {0, 0, 0, 0});
  CHECK_THROWS_WITH(to_geojson(invented, problem(), {}), Contains("'synthetic:7' is invented"));
  CHECK_THROWS_WITH(to_flight_plan(invented, problem(), route().route),
                    Contains("'synthetic:7' is invented"));
  CHECK_THROWS_WITH(to_flight_plan(level(51, 6), problem(), {}), Contains("fewer than two"));
}
