#include "navigation/planners/route_making.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "navigation/planners/curved_path.hpp"
#include "navigation/planners/problem_rules.hpp"
#include "navigation/planners/turn_arc.hpp"
#include "navigation/terrain/ground_clearance.hpp"
#include "navigation/threats/radar_exposure.hpp"
#include "navigation/threats/threat_models.hpp"

namespace skein::navigation {
namespace {

double length_m(const GroundPath& path) {
  double sum = 0;
  for (std::size_t i = 1; i < path.size(); ++i) sum += distance_m(path[i - 1], path[i]);
  return sum;
}

GroundPath flyable_path(const PlanningScene& scene, const GroundPath& path, const LegCost& cost,
                        int max_points) {
  // A little wider than the limit, so that the tangents of the arc are within it too.
  const double radius = 1.03 * turn_radius_m(scene.problem().limits);
  const double step = std::max(scene.grid().spacing_m(), length_m(path) / max_points);
  for (const double finer : {1.0, 0.6}) {
    const GroundPath points = divide(thin(scene, path, finer * step), finer * step);
    if (const auto taut = pull_taut(scene, points, cost, radius)) {
      return round_corners(*taut, radius);
    }
  }
  const double spaced = 2 * radius;
  if (const auto curved = curve(scene, divide(thin(scene, path, spaced), spaced), radius)) {
    return *curved;
  }
  throw Unflyable(fmt::format(
      "the way between zones and ground has bends too tight for a turn radius of {:.0f} m",
      radius));
}

/// Both the edges and the turns between them, as they are flown, must keep clear of zones and
/// ground.
class LastLook {
 public:
  LastLook(const PlanningScene& scene, const std::vector<Position>& waypoints)
      : scene_(scene), waypoints_(waypoints), radius_m_(turn_radius_m(scene.problem().limits)) {
    for (const auto& zone : scene.problem().no_fly_zones) zones_.emplace_back(zone, 0);
  }

  /// Throws Unflyable.
  void take() const {
    double turned_m = 0;  // How much of the edge the turn at its begin takes.
    for (std::size_t i = 1; i < waypoints_.size(); ++i) {
      require_outside_zones(waypoints_[i - 1], waypoints_[i]);
      const double to_turn_m = i + 1 < waypoints_.size() ? turn(i) : 0;
      if (turned_m + to_turn_m > distance_m(on_map(waypoints_[i - 1]), on_map(waypoints_[i]))) {
        throw Unflyable("two turns follow each other too closely");
      }
      turned_m = to_turn_m;
    }
  }

 private:
  /// How much of either edge the turn at the waypoint takes.
  double turn(std::size_t i) const {
    const Position& before = waypoints_[i - 1];
    const Position& after = waypoints_[i + 1];
    const auto arc = turn_arc(before, waypoints_[i], after, radius_m_);
    for (std::size_t point = 1; point < arc.size(); ++point) {
      require_outside_zones(arc[point - 1], arc[point]);
      if (ground_clearance(scene_.terrain(), arc[point - 1], arc[point]).lowest_m <
          scene_.problem().minimum_height_above_ground_m) {
        throw Unflyable("the ground inside of a turn is too high for the minimum height");
      }
    }
    if (radius_m_ == 0) return 0;
    return radius_m_ * tangent_share(on_map(before), on_map(waypoints_[i]), on_map(after));
  }

  void require_outside_zones(const Position& a, const Position& b) const {
    for (const KeepOut& zone : zones_) {
      if (!zone.crossed_by(a, b)) continue;
      throw Unflyable(fmt::format("a turn or a descent enters the no-fly zone '{}'", zone.name()));
    }
  }

  const PlanningScene& scene_;
  const std::vector<Position>& waypoints_;
  double radius_m_;
  std::vector<KeepOut> zones_;
};

}  // namespace

AE_navigator::Route make_route(const PlanningScene& scene, const GroundPath& path,
                               const LegCost& cost, int max_points, std::string planner) {
  AE_navigator::Route route;
  route.planner = std::move(planner);
  route.waypoints = fly_over(scene, flyable_path(scene, path, cost, max_points));
  route.waypoints.front() = scene.problem().start;
  route.waypoints.back() = scene.problem().goal;
  LastLook(scene, route.waypoints).take();

  route.length_m = 0;
  route.lowest_height_above_ground_m = std::numeric_limits<double>::infinity();
  for (std::size_t i = 1; i < route.waypoints.size(); ++i) {
    const Position& a = route.waypoints[i - 1];
    const Position& b = route.waypoints[i];
    route.length_m += std::hypot(distance_m(on_map(a), on_map(b)), b.altitude_m - a.altitude_m);
    route.lowest_height_above_ground_m = std::min(route.lowest_height_above_ground_m,
                                                  ground_clearance(scene.terrain(), a, b).lowest_m);
  }
  if (route.lowest_height_above_ground_m < scene.problem().minimum_height_above_ground_m) {
    throw Unflyable("the ground beside start or goal is too steep for the minimum height");
  }
  const RadarExposure exposure(scene.terrain(), scene.problem().radar_sites);
  route.radar_exposure = exposure.along(route.waypoints);
  const MissileThreat missiles(scene.terrain(), scene.problem().missile_sites);
  route.expected_kills = missiles.expected_kills(route.waypoints, scene.problem().limits.speed_m_s);
  route.threat_epoch = scene.problem().threat_epoch;
  return route;
}

}  // namespace skein::navigation
