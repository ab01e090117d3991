#include "navigation/routes/demo_problem.hpp"

#include <algorithm>
#include <string>
#include <utility>

namespace skein::navigation {
namespace {

using AE_navigator::GroundPoint;
using AE_navigator::NoFlyZone;
using AE_navigator::Position;
using AE_navigator::Problem;

/// Places things on a terrain of any size: coordinates and sizes are shares of its extents.
class Placing {
 public:
  explicit Placing(const Terrain& terrain)
      : terrain_(terrain),
        shorter_m_(std::min(terrain.north_extent_m(), terrain.east_extent_m())) {}

  GroundPoint point(double north, double east) const {
    return {north * terrain_.north_extent_m(), east * terrain_.east_extent_m()};
  }
  double metres(double share) const { return share * shorter_m_; }

  Position above_ground(double north, double east, double height_m) const {
    const GroundPoint p = point(north, east);
    return {p.north_m, p.east_m, terrain_.height_m(p.north_m, p.east_m) + height_m};
  }

  void add_radar(Problem& problem, std::string name, double north, double east,
                 double range) const {
    problem.radar_sites.push_back({std::move(name), hill_near(north, east), 20, metres(range), 1});
  }

 private:
  /// The highest post within a few kilometres: radars stand where they see far.
  GroundPoint hill_near(double north, double east) const {
    constexpr double kAround = 0.02;
    GroundPoint best = point(north, east);
    for (double n = north - kAround; n <= north + kAround; n += 0.002) {
      for (double e = east - kAround; e <= east + kAround; e += 0.002) {
        const GroundPoint p = point(n, e);
        if (terrain_.height_m(p.north_m, p.east_m) > terrain_.height_m(best.north_m, best.east_m)) {
          best = p;
        }
      }
    }
    return best;
  }

  const Terrain& terrain_;
  double shorter_m_;
};

constexpr double kFloor_m = -1000;  ///< Below all ground.
constexpr double kCeiling_m = 20000;

}  // namespace

Problem demo_problem(const Terrain& terrain) {
  const Placing place(terrain);
  Problem problem;
  problem.terrain = terrain.name();
  problem.start = place.above_ground(0.08, 0.10, 250);
  problem.goal = place.above_ground(0.88, 0.91, 250);
  problem.no_fly_zones = {
      {"City", {place.point(0.36, 0.33)}, place.metres(0.07), kFloor_m, kCeiling_m},
      {"Reserve",
       {place.point(0.62, 0.52), place.point(0.70, 0.56), place.point(0.66, 0.72),
        place.point(0.55, 0.66)},
       0,
       kFloor_m,
       kCeiling_m},
      {"Corridor",
       {place.point(0.60, 0.14), place.point(0.84, 0.34)},
       place.metres(0.025),
       kFloor_m,
       kCeiling_m},
  };
  place.add_radar(problem, "Alpha", 0.30, 0.62, 0.16);
  place.add_radar(problem, "Bravo", 0.54, 0.38, 0.15);
  place.add_radar(problem, "Charlie", 0.48, 0.86, 0.14);
  place.add_radar(problem, "Delta", 0.80, 0.60, 0.13);
  problem.minimum_height_above_ground_m = 120;
  problem.limits = {60, 12, 30, terrain.highest_m() + 500.0};
  problem.exposure_weight = 1;
  problem.time_limit_ms = 0;
  return problem;
}

Problem unreachable_demo_problem(const Terrain& terrain) {
  const Placing place(terrain);
  Problem problem = demo_problem(terrain);
  const auto wall = [&](std::string name, GroundPoint from, GroundPoint to) {
    problem.no_fly_zones.push_back(
        {std::move(name), {from, to}, place.metres(0.012), kFloor_m, kCeiling_m});
  };
  const GroundPoint south_west = place.point(0.83, 0.82);
  const GroundPoint north_west = place.point(0.97, 0.82);
  const GroundPoint north_east = place.point(0.97, 0.97);
  const GroundPoint south_east = place.point(0.83, 0.97);
  wall("West Wall", south_west, north_west);
  wall("North Wall", north_west, north_east);
  wall("East Wall", north_east, south_east);
  wall("South Wall", south_east, south_west);
  return problem;
}

}  // namespace skein::navigation
