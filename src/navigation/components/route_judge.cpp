#include "route_judge.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "navigation/planners/problem_rules.hpp"
#include "navigation/planners/turn_arc.hpp"
#include "navigation/terrain/ground_clearance.hpp"
#include "navigation/threats/keep_out.hpp"
#include "navigation/threats/radar_exposure.hpp"

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
constexpr double kDegree = std::numbers::pi / 180;

bool finite(const Position& p) {
  return std::isfinite(p.north_m) && std::isfinite(p.east_m) && std::isfinite(p.altitude_m);
}

double map_distance_m(const Position& a, const Position& b) {
  return distance_m(on_map(a), on_map(b));
}

Flaw judge_numbers(const Route& route) {
  const bool all = std::all_of(route.waypoints.begin(), route.waypoints.end(), finite) &&
                   std::isfinite(route.length_m) && std::isfinite(route.radar_exposure) &&
                   std::isfinite(route.expected_kills) &&
                   std::isfinite(route.lowest_height_above_ground_m);
  return all ? Flaw() : "it holds a number that is not finite";
}

Flaw judge_ends(const Problem& problem, const Route& route) {
  if (route.waypoints.size() < 2) return "it has fewer than two waypoints";
  const double from_m = slant_range_m(route.waypoints.front(), problem.start);
  if (from_m > kPosition_m) return fmt::format("it begins {:.1f} m from the start", from_m);
  const double to_m = slant_range_m(route.waypoints.back(), problem.goal);
  if (to_m > kPosition_m) return fmt::format("it ends {:.1f} m from the goal", to_m);
  return std::nullopt;
}

/// The first flaw that `judge` finds in an edge, with the edge's place.
template <class Judge>
Flaw judge_edges(const Route& route, Judge judge) {
  for (std::size_t i = 1; i < route.waypoints.size(); ++i) {
    if (const Flaw flaw = judge(route.waypoints[i - 1], route.waypoints[i]))
      return fmt::format("between waypoints {} and {} {}", i - 1, i, *flaw);
  }
  return std::nullopt;
}

/// The same along the turns, as they are flown.
template <class Judge>
Flaw judge_arcs(const Problem& problem, const Route& route, Judge judge) {
  const auto& points = route.waypoints;
  for (std::size_t i = 1; i + 1 < points.size(); ++i) {
    const auto arc =
        turn_arc(points[i - 1], points[i], points[i + 1], turn_radius_m(problem.limits));
    for (std::size_t point = 1; point < arc.size(); ++point) {
      if (const Flaw flaw = judge(arc[point - 1], arc[point]))
        return fmt::format("in the turn at waypoint {} {}", i, *flaw);
    }
  }
  return std::nullopt;
}

Flaw judge_zones(const std::vector<KeepOut>& zones, const Position& a, const Position& b) {
  for (const KeepOut& zone : zones) {
    if (zone.crossed_by(a, b)) return fmt::format("it enters the no-fly zone '{}'", zone.name());
  }
  return std::nullopt;
}

Flaw judge_height(const Terrain& terrain, const Problem& problem, const Position& a,
                  const Position& b) {
  const double height_m = ground_clearance(terrain, a, b).lowest_m;
  if (height_m >= problem.minimum_height_above_ground_m - kHeight_m) return std::nullopt;
  return fmt::format("it comes within {:.1f} m of the ground; {:.1f} m are demanded", height_m,
                     problem.minimum_height_above_ground_m);
}

Flaw judge_altitude(const Problem& problem, const Position& a, const Position& b) {
  const double highest_m = std::max(a.altitude_m, b.altitude_m);
  if (highest_m <= problem.limits.maximum_altitude_m + kHeight_m) return std::nullopt;
  return fmt::format("it climbs to {:.0f} m; the aircraft flies no higher than {:.0f} m", highest_m,
                     problem.limits.maximum_altitude_m);
}

Flaw judge_climb(const Problem& problem, const Position& a, const Position& b) {
  const double climb =
      std::atan2(std::abs(b.altitude_m - a.altitude_m), map_distance_m(a, b)) / kDegree;
  if (climb <= problem.limits.maximum_climb_angle_deg + kAngle_deg) return std::nullopt;
  return fmt::format("it climbs at {:.1f} degrees; the aircraft climbs at no more than {:.1f}",
                     climb, problem.limits.maximum_climb_angle_deg);
}

double heading(const Position& a, const Position& b) {
  return std::atan2(b.east_m - a.east_m, b.north_m - a.north_m);
}

/// An arc that is tangential to both edges takes radius * tan(turn / 2) of each.
Flaw judge_turns(const Problem& problem, const Route& route) {
  const auto& limits = problem.limits;
  if (limits.maximum_bank_angle_deg == 0) return std::nullopt;
  const double radius_m = turn_radius_m(limits);
  const auto& points = route.waypoints;
  double before_m = 0;
  for (std::size_t i = 1; i < points.size(); ++i) {
    double after_m = 0;
    if (i + 1 < points.size()) {
      const double turn = std::abs(
          std::remainder(heading(points[i], points[i + 1]) - heading(points[i - 1], points[i]),
                         2 * std::numbers::pi));
      after_m = radius_m * std::tan(std::min(turn, 179.999 * kDegree) / 2);
    }
    const double length_m = map_distance_m(points[i - 1], points[i]);
    if (before_m + after_m > length_m + kPosition_m) {
      return fmt::format(
          "between waypoints {} and {} it has {:.0f} m for turns that take {:.0f} m at a radius of "
          "{:.0f} m",
          i - 1, i, length_m, before_m + after_m, radius_m);
    }
    before_m = after_m;
  }
  return std::nullopt;
}

Flaw judge_exposure(const Terrain& terrain, const Problem& problem, const Route& route) {
  if (problem.exposure_cap_m == 0) return std::nullopt;
  const double exposure_m = RadarExposure(terrain, problem.radar_sites).along(route.waypoints);
  if (exposure_m <= problem.exposure_cap_m) return std::nullopt;
  return fmt::format("its exposure is {:.1f} km; the cap is {:.1f} km", exposure_m / 1000,
                     problem.exposure_cap_m / 1000);
}

Flaw judge_epoch(const Problem& problem, const Route& route, std::uint32_t known) {
  if (problem.threat_epoch == 0 || route.threat_epoch >= known) return std::nullopt;
  return fmt::format("it was planned with threat picture {}; by now picture {} is known",
                     route.threat_epoch, known);
}

}  // namespace

Evaluation<Route> judgement(const Terrain& terrain, const Problem& problem,
                            std::function<std::uint32_t()> epoch) {
  std::vector<KeepOut> zones;
  for (const auto& zone : problem.no_fly_zones) zones.emplace_back(zone, 0);
  const auto by_edges = [](auto judge) {
    return [judge = std::move(judge)](const Route& route) { return judge_edges(route, judge); };
  };
  Evaluation<Route> evaluation;
  evaluation.check("finite", judge_numbers)
      .check("start and goal", [&](const Route& route) { return judge_ends(problem, route); })
      .check("terrain", by_edges([&](const Position&, const Position& b) -> Flaw {
               if (terrain.contains(b.north_m, b.east_m)) return std::nullopt;
               return "it leaves the terrain";
             }))
      .check("no-fly zone", by_edges([zones](const Position& a, const Position& b) {
               return judge_zones(zones, a, b);
             }))
      .check("height above ground", by_edges([&](const Position& a, const Position& b) {
               return judge_height(terrain, problem, a, b);
             }))
      .check("altitude", by_edges([&](const Position& a, const Position& b) {
               return judge_altitude(problem, a, b);
             }))
      .check("climb", by_edges([&](const Position& a, const Position& b) {
               return judge_climb(problem, a, b);
             }))
      .check("turn radius", [&](const Route& route) { return judge_turns(problem, route); })
      .check("turn",
             [&, zones](const Route& route) {
               return judge_arcs(problem, route, [&](const Position& a, const Position& b) {
                 const Flaw flaw = judge_zones(zones, a, b);
                 return flaw ? flaw : judge_height(terrain, problem, a, b);
               });
             })
      .admitted("exposure cap",
                [&](const Route& route) { return judge_exposure(terrain, problem, route); })
      .admitted("threat epoch", [&problem, epoch = std::move(epoch)](const Route& route) {
        return judge_epoch(problem, route, epoch());
      });
  return evaluation;
}

}  // namespace skein::navigation
