#include "route_judge.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "skein/navigation/ground_clearance.hpp"
#include "skein/navigation/keep_out.hpp"

namespace skein::navigation {
namespace {

using AE_navigator::Position;
using AE_navigator::Problem;
using AE_navigator::Route;
using Flaw = std::optional<std::string>;

// What rounding may cost; the checker allows for as much.
constexpr double kPosition_m = 0.01;
constexpr double kHeight_m = 0.1;
constexpr double kAngle_deg = 0.01;

bool finite(const Position& p) {
  return std::isfinite(p.north_m) && std::isfinite(p.east_m) && std::isfinite(p.altitude_m);
}

double distance_m(const Position& a, const Position& b) {
  return std::hypot(a.north_m - b.north_m, a.east_m - b.east_m, a.altitude_m - b.altitude_m);
}

Flaw judge_ends(const Problem& problem, const Route& route) {
  if (route.waypoints.size() < 2) return "it has fewer than two waypoints";
  if (!std::all_of(route.waypoints.begin(), route.waypoints.end(), finite) ||
      !std::isfinite(route.length_m) || !std::isfinite(route.radar_exposure) ||
      !std::isfinite(route.lowest_height_above_ground_m)) {
    return "it holds a number that is not finite";
  }
  const double from_m = distance_m(route.waypoints.front(), problem.start);
  if (from_m > kPosition_m) return fmt::format("it begins {:.1f} m from the start", from_m);
  const double to_m = distance_m(route.waypoints.back(), problem.goal);
  if (to_m > kPosition_m) return fmt::format("it ends {:.1f} m from the goal", to_m);
  return std::nullopt;
}

double climb_deg(const Position& a, const Position& b) {
  const double ground_m = std::hypot(b.north_m - a.north_m, b.east_m - a.east_m);
  return std::atan2(std::abs(b.altitude_m - a.altitude_m), ground_m) * 180 / std::numbers::pi;
}

Flaw judge_edge(const Terrain& terrain, const Problem& problem, const std::vector<KeepOut>& zones,
                const Position& a, const Position& b) {
  if (!terrain.contains(b.north_m, b.east_m)) return "it leaves the terrain";
  for (const KeepOut& zone : zones) {
    if (zone.crossed_by(a, b)) return fmt::format("it enters the no-fly zone '{}'", zone.name());
  }
  const double height_m = ground_clearance(terrain, a, b).lowest_m;
  if (height_m < problem.minimum_height_above_ground_m - kHeight_m) {
    return fmt::format("it comes within {:.1f} m of the ground; {:.1f} m are demanded", height_m,
                       problem.minimum_height_above_ground_m);
  }
  const double highest_m = std::max(a.altitude_m, b.altitude_m);
  if (highest_m > problem.limits.maximum_altitude_m + kHeight_m) {
    return fmt::format("it climbs to {:.0f} m; the aircraft flies no higher than {:.0f} m",
                       highest_m, problem.limits.maximum_altitude_m);
  }
  const double climb = climb_deg(a, b);
  if (climb <= problem.limits.maximum_climb_angle_deg + kAngle_deg) return std::nullopt;
  return fmt::format("it climbs at {:.1f} degrees; the aircraft climbs at no more than {:.1f}",
                     climb, problem.limits.maximum_climb_angle_deg);
}

}  // namespace

Flaw judge_route(const Terrain& terrain, const Problem& problem, const Route& route) {
  if (const Flaw flaw = judge_ends(problem, route)) return flaw;
  std::vector<KeepOut> zones;
  for (const auto& zone : problem.no_fly_zones) zones.emplace_back(zone, 0);
  for (std::size_t i = 1; i < route.waypoints.size(); ++i) {
    const Position& a = route.waypoints[i - 1];
    const Position& b = route.waypoints[i];
    const Flaw flaw = judge_edge(terrain, problem, zones, a, b);
    if (flaw) return fmt::format("between waypoints {} and {} {}", i - 1, i, *flaw);
  }
  return std::nullopt;
}

}  // namespace skein::navigation
