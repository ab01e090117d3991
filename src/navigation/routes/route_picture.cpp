#include "navigation/routes/route_picture.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "navigation/terrain/plane_geometry.hpp"
#include "navigation/threats/radar_exposure.hpp"
#include "navigation/threats/risk_map.hpp"

namespace skein::navigation {
namespace {

using Json = nlohmann::ordered_json;

constexpr int kCells = 360;  ///< Of the ground, along the terrain's longer side.
constexpr int kSamples = 360;

/// How strongly an exposure rate is tinted, 0 to 100: from a twentieth of a radar's strength
/// upwards, by the logarithm.
long tint(double exposure_rate) {
  constexpr double kLeast = 0.05;
  if (!(exposure_rate > kLeast)) return 0;
  return std::lround(100 * std::min(1.0, std::log(exposure_rate / kLeast) / std::log(60 / kLeast)));
}

Json north_east(const GroundPoint& point) {
  return {std::lround(point.north_m), std::lround(point.east_m)};
}

Json ground(const Terrain& terrain, const AE_navigator::Problem& problem) {
  const PlanningGrid grid(terrain, 0);
  std::vector<float> altitudes;
  for (int node = 0; node < grid.size(); ++node) {
    const GroundPoint point = grid.point(node);
    altitudes.push_back(static_cast<float>(terrain.height_m(point.north_m, point.east_m) +
                                           problem.minimum_height_above_ground_m));
  }
  RiskMap risk(terrain, grid, altitudes);
  risk.add(problem.radar_sites, 1);

  const double spacing_m = std::max(terrain.north_extent_m(), terrain.east_extent_m()) / kCells;
  const auto count = [&](double extent_m) { return 1 + std::lround(extent_m / spacing_m); };
  const long rows = count(terrain.north_extent_m()), columns = count(terrain.east_extent_m());
  Json heights = Json::array(), seen = Json::array();
  for (long row = 0; row < rows; ++row) {
    for (long column = 0; column < columns; ++column) {
      const GroundPoint point{static_cast<double>(row) * spacing_m,
                              static_cast<double>(column) * spacing_m};
      heights.push_back(std::lround(terrain.height_m(point.north_m, point.east_m)));
      seen.push_back(tint(risk.rate(point)));
    }
  }
  return {{"south_m", 0},
          {"west_m", 0},
          {"spacing_m", spacing_m},
          {"columns", columns},
          {"heights_m", std::move(heights)},
          {"seen", std::move(seen)}};
}

/// Of points evenly spread over the way: the distance flown over the map, the heights of ground and
/// flight, and how strongly radars see the aircraft.
Json profile(const Terrain& terrain, const RadarExposure& exposure,
             const std::vector<Position>& waypoints) {
  std::vector<double> flown{0};
  for (std::size_t i = 1; i < waypoints.size(); ++i) {
    flown.push_back(flown.back() + distance_m(on_map(waypoints[i - 1]), on_map(waypoints[i])));
  }
  Json samples = Json::array();
  std::size_t i = 1;
  for (int sample = 0; sample <= kSamples; ++sample) {
    const double distance = flown.back() * sample / kSamples;
    while (i + 1 < flown.size() && flown[i] < distance) ++i;
    const double edge = flown[i] - flown[i - 1];
    const Position here = between(waypoints[i - 1], waypoints[i],
                                  edge > 0 ? std::min((distance - flown[i - 1]) / edge, 1.0) : 0);
    samples.push_back({std::lround(distance),
                       std::lround(terrain.height_m(here.north_m, here.east_m)),
                       std::lround(here.altitude_m), tint(exposure.rate(here))});
  }
  return samples;
}

Json route_of(const Terrain& terrain, const RadarExposure& exposure,
              const PicturedRoute& pictured) {
  const AE_navigator::Route& route = pictured.route;
  Json json{{"label", pictured.label},
            {"length_m", route.length_m},
            {"exposure_m", route.radar_exposure},
            {"lowest_m", route.lowest_height_above_ground_m},
            {"points", nullptr}};
  if (!drawable(route)) return json;
  json["points"] = Json::array();
  for (const Position& point : route.waypoints) json["points"].push_back(north_east(on_map(point)));
  json["profile"] = profile(terrain, exposure, route.waypoints);
  return json;
}

template <class Site>
Json sites(const std::vector<Site>& all) {
  Json list = Json::array();
  for (const Site& each : all) {
    list.push_back(
        {{"name", each.name}, {"place", north_east(each.site)}, {"range_m", each.range_m}});
  }
  return list;
}

}  // namespace

std::string route_picture(const Terrain& terrain, const AE_navigator::Problem& problem,
                          std::span<const PicturedRoute> routes, const std::string& title) {
  Json zones = Json::array(), drawn = Json::array();
  for (const auto& zone : problem.no_fly_zones) {
    Json outline = Json::array();
    for (const GroundPoint& corner : zone.outline) outline.push_back(north_east(corner));
    zones.push_back({{"name", zone.name}, {"margin_m", zone.margin_m}, {"outline", outline}});
  }
  const RadarExposure exposure(terrain, problem.radar_sites);
  for (const PicturedRoute& route : routes) drawn.push_back(route_of(terrain, exposure, route));
  return Json{{"title", title},
              {"facts",
               {fmt::format("{} route{}", routes.size(), routes.size() == 1 ? "" : "s"),
                fmt::format("terrain {}", terrain.name()),
                fmt::format("{:.0f} km by {:.0f} km", terrain.north_extent_m() / 1000,
                            terrain.east_extent_m() / 1000),
                fmt::format("{:.0f} m to {:.0f} m", terrain.lowest_m(), terrain.highest_m())}},
              {"start", north_east(on_map(problem.start))},
              {"goal", north_east(on_map(problem.goal))},
              {"above_m", problem.minimum_height_above_ground_m},
              {"zones", std::move(zones)},
              {"radars", sites(problem.radar_sites)},
              {"missiles", sites(problem.missile_sites)},
              {"routes", std::move(drawn)},
              {"ground", ground(terrain, problem)}}
      .dump(-1, ' ', false, Json::error_handler_t::replace);
}

bool drawable(const AE_navigator::Route& route) {
  return route.waypoints.size() > 1 &&
         std::all_of(route.waypoints.begin(), route.waypoints.end(), [](const Position& p) {
           return std::isfinite(p.north_m) && std::isfinite(p.east_m) &&
                  std::isfinite(p.altitude_m);
         });
}

}  // namespace skein::navigation
