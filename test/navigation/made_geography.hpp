#pragma once

#include "navigation/routes/route_picture.hpp"
#include "navigation/terrain/terrain.hpp"

// Zones, sites and a route somewhere on the earth, to be written as GeoJSON and as a flight plan.
namespace skein::navigation::testing {

/// Level ground of 111 by 70 km about a place.
inline Terrain level(double latitude_deg, double longitude_deg) {
  return Terrain("level", 2, 2, 111000, 70000, {100, 100, 100, 100},
                 EarthFrame({latitude_deg, longitude_deg}, {55500, 35000}));
}

inline AE_navigator::Problem problem() {
  AE_navigator::Problem made;
  made.no_fly_zones = {{"Tower", {{20000, 30000}}, 2500, 0, 1500},
                       {"Valley", {{60000, 10000}, {64000, 31000}}, 800, -100, 900},
                       {"Town",
                        {{30000, 50000}, {30000, 60000}, {52000, 60000}, {40000, 55000}},
                        300,
                        -1000,
                        20000}};
  made.radar_sites = {{"Alpha", {40000, 40000}, 20, 9000, 1}};
  made.missile_sites = {{"Sierra", {50000, 20000}, 10, 4000, 0.02}};
  made.limits = {60, 10, 30, 3000};
  return made;
}

inline PicturedRoute route() {
  PicturedRoute made;
  made.label = "first";
  made.route.waypoints = {{5000, 5000, 300}, {50000, 9000, 800}, {105000, 66000, 450.5}};
  made.route.length_m = 125000;
  made.route.planner = "AStar";
  return made;
}

/// A zone around whose middle the antimeridian cuts off two arms, where the middle of the terrain
/// is 10.6 km west of it.
inline AE_navigator::NoFlyZone forked_zone() {
  return {"Fork",
          {{10000, 30000},
           {10000, 60000},
           {20000, 60000},
           {20000, 40000},
           {30000, 40000},
           {30000, 62000},
           {40000, 62000},
           {40000, 30000}},
          0,
          0,
          1000};
}

}  // namespace skein::navigation::testing
