#pragma once

#include <filesystem>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "navigation/routes/route_picture.hpp"
#include "navigation/terrain/terrain.hpp"
#include "navigator.idl.hpp"

// GeoJSON, as RFC 7946 has it: WGS-84, longitude before latitude, outlines against the clock, and
// nothing across the antimeridian, where geometries are cut in two.
namespace skein::navigation {

/// The property `kind` of a zone.
inline constexpr const char* kZoneKind = "no_fly_zone";

/// Zones, sites and routes as one FeatureCollection; the property `kind` says what each feature is:
/// `no_fly_zone`, `radar_site`, `missile_site` or `route`.
///
/// A zone of one corner is a point, of two a line, of more a polygon; its property `margin_m`
/// belongs to it. Lines straight in the terrain's frame are not quite straight in degrees, so they
/// have a position every 2 km at most, which keeps them within a metre. GeoJSON's third coordinate
/// would be a height above the ellipsoid, and none is given: heights are properties, in metres
/// above the geoid; `altitudes_m` of a route has one for each position. A route with a number that
/// is not finite is left out. Throws InvalidArgument for a terrain that lies nowhere on the earth.
std::string to_geojson(const Terrain& terrain, const AE_navigator::Problem& problem,
                       std::span<const PicturedRoute> routes);

/// The no-fly zones of a GeoJSON text: a FeatureCollection or a Feature. `source` names the text in
/// errors, such as the file that it is from.
///
/// A Polygon is a zone, a Point one with a radius of `margin_m`, a LineString a corridor of
/// `margin_m` on both sides, and each part of a MultiPolygon or MultiLineString a zone of its own.
/// A position that is given twice in a row counts once. A `crs` may name WGS-84. Properties:
/// `name`; `floor_m` and `ceiling_m` above the geoid, without which a zone reaches from below all
/// ground to 20 km; `margin_m`, needed by points and lines. Features with another `kind` than
/// `no_fly_zone` are passed over.
///
/// Throws InvalidArgument with the place in the text (line and column, or a JSON pointer such as
/// /features/2/geometry/coordinates/0/3) where it is not JSON or not such GeoJSON, an outline is
/// not closed, encloses nothing, has a hole, crosses itself or has more corners than a Problem
/// takes, a place is not on the earth or more than 1000 km from the terrain; and for a terrain that
/// lies nowhere on the earth.
std::vector<AE_navigator::NoFlyZone> zones_from_geojson(std::string_view text,
                                                        const std::string& source,
                                                        const Terrain& terrain);

}  // namespace skein::navigation
