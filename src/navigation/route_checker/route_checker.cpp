#include "navigation/route_checker/route_checker.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "rules.hpp"
#include "skein/error.hpp"

namespace skein::navigation {
namespace {

using AE_navigator::Position;
using AE_navigator::Problem;
using AE_navigator::Route;

constexpr std::size_t kMaxWaypoints = 100000;
constexpr double kLongestRoute = 50;  ///< In widths of the terrain: what is longer is an attack.
constexpr double kDegree = std::numbers::pi / 180;

bool finite(const Position& p) {
  return std::isfinite(p.north_m) && std::isfinite(p.east_m) && std::isfinite(p.altitude_m);
}

bool finite(const AE_navigator::NoFlyZone& zone) {
  return std::isfinite(zone.margin_m) && std::isfinite(zone.floor_m) &&
         std::isfinite(zone.ceiling_m) &&
         std::all_of(zone.outline.begin(), zone.outline.end(), [](const auto& corner) {
           return std::isfinite(corner.north_m) && std::isfinite(corner.east_m);
         });
}

bool finite(const AE_navigator::RadarSite& site) {
  return std::isfinite(site.site.north_m) && std::isfinite(site.site.east_m) &&
         std::isfinite(site.mast_height_m) && std::isfinite(site.range_m) &&
         std::isfinite(site.strength);
}

bool finite(const AE_navigator::MissileSite& site) {
  return std::isfinite(site.site.north_m) && std::isfinite(site.site.east_m) &&
         std::isfinite(site.mast_height_m) && std::isfinite(site.range_m) &&
         std::isfinite(site.kills_per_second);
}

double map_length(const Position& a, const Position& b) {
  return std::hypot(b.north_m - a.north_m, b.east_m - a.east_m);
}

double air_length(const Position& a, const Position& b) {
  return std::hypot(b.north_m - a.north_m, b.east_m - a.east_m, b.altitude_m - a.altitude_m);
}

/// Whether the whole zone is further away than `distance` from the point, to the north, south, east
/// or west.
bool is_far(const AE_navigator::NoFlyZone& zone, const Position& point, double distance) {
  const double reach = distance + zone.margin_m;
  const auto all = [&](auto beyond) {
    return std::all_of(zone.outline.begin(), zone.outline.end(), beyond);
  };
  return all([&](const auto& c) { return c.north_m > point.north_m + reach; }) ||
         all([&](const auto& c) { return c.north_m < point.north_m - reach; }) ||
         all([&](const auto& c) { return c.east_m > point.east_m + reach; }) ||
         all([&](const auto& c) { return c.east_m < point.east_m - reach; });
}

Position towards(const Position& a, const Position& b, double share) {
  return {a.north_m + share * (b.north_m - a.north_m), a.east_m + share * (b.east_m - a.east_m),
          a.altitude_m + share * (b.altitude_m - a.altitude_m)};
}

class Check {
 public:
  Check(const Problem& problem, const Route& route, const HeightGrid& ground,
        const RouteTolerances& tolerances)
      : problem_(problem),
        points_(route.waypoints),
        route_(route),
        ground_(ground),
        tolerances_(tolerances) {}

  std::vector<RouteViolation> run() {
    check_numbers();
    if (!violations_.empty()) return violations_;
    check_ends();
    check_places();
    check_edges();
    check_turns();
    check_claims();
    return violations_;
  }

 private:
  template <class... Arguments>
  void report(RouteRule rule, fmt::format_string<Arguments...> text, Arguments&&... arguments) {
    violations_.push_back({rule, fmt::format(text, std::forward<Arguments>(arguments)...)});
  }

  void check_numbers() {
    if (points_.size() < 2 || points_.size() > kMaxWaypoints) {
      report(RouteRule::Continuity, "the route has {} waypoints; a route has 2 to {}",
             points_.size(), kMaxWaypoints);
    }
    for (std::size_t i = 0; i < points_.size(); ++i) {
      if (!finite(points_[i])) {
        report(RouteRule::Finite, "waypoint {} is ({}, {}, {}), which is not finite", i,
               points_[i].north_m, points_[i].east_m, points_[i].altitude_m);
      }
    }
    for (const auto& zone : problem_.no_fly_zones) {
      if (!finite(zone)) {
        report(RouteRule::Finite, "no-fly zone '{}' of the problem is not finite", zone.name);
      }
    }
    for (const auto& site : problem_.radar_sites) {
      if (!finite(site)) {
        report(RouteRule::Finite, "radar site '{}' of the problem is not finite", site.name);
      }
    }
    for (const auto& site : problem_.missile_sites) {
      if (!finite(site)) {
        report(RouteRule::Finite, "missile site '{}' of the problem is not finite", site.name);
      }
    }
    if (!std::isfinite(route_.length_m)) {
      report(RouteRule::Finite, "the claimed length is {}", route_.length_m);
    }
    if (!std::isfinite(route_.lowest_height_above_ground_m)) {
      report(RouteRule::Finite, "the claimed lowest height above ground is {}",
             route_.lowest_height_above_ground_m);
    }
    if (!std::isfinite(route_.radar_exposure)) {
      report(RouteRule::Finite, "the claimed exposure is {}", route_.radar_exposure);
    }
    if (!std::isfinite(route_.expected_kills)) {
      report(RouteRule::Finite, "the claimed number of expected kills is {}",
             route_.expected_kills);
    }
  }

  void check_ends() {
    const double from_start = air_length(points_.front(), problem_.start);
    const double from_goal = air_length(points_.back(), problem_.goal);
    if (!(from_start <= tolerances_.position_m)) {
      report(RouteRule::Start, "waypoint 0 is {:.2f} m away from the start", from_start);
    }
    if (!(from_goal <= tolerances_.position_m)) {
      report(RouteRule::Goal, "waypoint {}, the last, is {:.2f} m away from the goal",
             points_.size() - 1, from_goal);
    }
  }

  void check_places() {
    const double north = (ground_.rows - 1) * ground_.north_spacing_m;
    const double east = (ground_.columns - 1) * ground_.east_spacing_m;
    for (std::size_t i = 0; i < points_.size(); ++i) {
      const Position& p = points_[i];
      if (p.north_m < 0 || p.east_m < 0 || p.north_m > north || p.east_m > east) {
        off_terrain_ = true;
        report(RouteRule::Terrain,
               "waypoint {}, {:.0f} m north and {:.0f} m east, is off the terrain of {:.0f} m by "
               "{:.0f} m",
               i, p.north_m, p.east_m, north, east);
      }
      if (!(p.altitude_m <= problem_.limits.maximum_altitude_m + tolerances_.height_m)) {
        report(RouteRule::Altitude, "waypoint {} is at {:.1f} m; the maximum altitude is {:.1f} m",
               i, p.altitude_m, problem_.limits.maximum_altitude_m);
      }
    }
  }

  void check_edges() {
    for (std::size_t i = 1; i < points_.size(); ++i) {
      check_shape(i - 1, points_[i - 1], points_[i]);
      check_zones(i - 1, points_[i - 1], points_[i]);
      if (!off_terrain_) check_ground(i - 1, points_[i - 1], points_[i]);
    }
  }

  void check_shape(std::size_t edge, const Position& a, const Position& b) {
    const double length = air_length(a, b);
    if (!(length > 0)) {
      report(RouteRule::Continuity, "edge {} has no length: waypoints {} and {} are the same", edge,
             edge, edge + 1);
    }
    length_m_ += length;
    const double angle =
        std::atan2(std::abs(b.altitude_m - a.altitude_m), map_length(a, b)) / kDegree;
    if (!(angle <= problem_.limits.maximum_climb_angle_deg + tolerances_.angle_deg)) {
      report(RouteRule::Climb, "edge {} {} at {:.2f} degrees; the limit is {:.2f} degrees", edge,
             b.altitude_m > a.altitude_m ? "climbs" : "descends", angle,
             problem_.limits.maximum_climb_angle_deg);
    }
  }

  void check_zones(std::size_t edge, const Position& a, const Position& b) {
    for (const auto& zone : problem_.no_fly_zones) {
      const double entry = route_checker::entry_into(zone, a, b);
      if (entry >= 0) {
        report(RouteRule::Zone, "edge {} enters the no-fly zone '{}' {:.1f} m after waypoint {}",
               edge, zone.name, entry * air_length(a, b), edge);
      }
    }
  }

  void check_ground(std::size_t edge, const Position& a, const Position& b) {
    const double height = route_checker::lowest_height(ground_, a, b);
    lowest_m_ = std::min(lowest_m_, height);
    if (!(height >= problem_.minimum_height_above_ground_m - tolerances_.height_m)) {
      report(RouteRule::Ground,
             "edge {} comes down to {:.1f} m above the ground; the minimum is {:.1f} m", edge,
             height, problem_.minimum_height_above_ground_m);
    }
  }

  /// The change of heading at a waypoint, 0 to pi.
  double turn_at(std::size_t i) const {
    const Position& a = points_[i - 1];
    const Position& b = points_[i];
    const Position& c = points_[i + 1];
    const double heading_in = std::atan2(b.east_m - a.east_m, b.north_m - a.north_m);
    const double heading_out = std::atan2(c.east_m - b.east_m, c.north_m - b.north_m);
    return std::abs(std::remainder(heading_out - heading_in, 2 * std::numbers::pi));
  }

  void check_turns() {
    const auto& limits = problem_.limits;
    if (limits.maximum_bank_angle_deg == 0) return;
    const double radius = limits.speed_m_s * limits.speed_m_s /
                          (9.80665 * std::tan(limits.maximum_bank_angle_deg * kDegree));
    double before = 0;  // How much of the edge the turn at its first waypoint takes.
    for (std::size_t i = 1; i < points_.size(); ++i) {
      const double available = map_length(points_[i - 1], points_[i]);
      const bool last = i + 1 == points_.size();
      const double turn = last ? 0 : turn_at(i);
      const double needed = radius * std::tan(std::min(turn, 179.999 * kDegree) / 2);
      if (!(before + needed <= available + tolerances_.position_m)) {
        report(RouteRule::Turn,
               "edge {} is {:.0f} m long; the turns at its ends take {:.0f} m and {:.0f} m with a "
               "radius of {:.0f} m",
               i - 1, available, before, needed, radius);
      } else if (turn > 0) {
        check_arc(i, turn, needed, radius);
      }
      before = needed;
    }
  }

  /// The arc of the turn at waypoint i, which begins `tangent` before it, as chords that nowhere
  /// leave it by more than the tolerance. Its first half has the altitudes of the edge before, its
  /// second half those of the edge after.
  std::vector<Position> arc_at(std::size_t i, double turn, double tangent, double radius) const {
    const Position& corner = points_[i];
    const double in = map_length(points_[i - 1], corner);
    const double out = map_length(corner, points_[i + 1]);
    const Position begin = towards(corner, points_[i - 1], std::min(1.0, tangent / in));
    const Position end = towards(corner, points_[i + 1], std::min(1.0, tangent / out));
    const double longest = 2 * std::acos(1 - std::min(1.0, tolerances_.position_m / radius));
    const int chords = 2 * static_cast<int>(std::clamp(std::ceil(turn / 2 / longest), 1.0, 1000.0));
    std::vector<Position> arc{begin};
    for (int chord = 1; chord < chords; ++chord) {
      const double share = static_cast<double>(chord) / chords;
      Position point =
          share <= 0.5 ? towards(begin, corner, 2 * share) : towards(corner, end, 2 * share - 1);
      // From the corner, along the two tangents, which are skew axes.
      const double to_begin = along_tangent(turn, 1 - share);
      const double to_end = along_tangent(turn, share);
      point.north_m = corner.north_m + to_begin * (begin.north_m - corner.north_m) +
                      to_end * (end.north_m - corner.north_m);
      point.east_m = corner.east_m + to_begin * (begin.east_m - corner.east_m) +
                     to_end * (end.east_m - corner.east_m);
      arc.push_back(point);
    }
    arc.push_back(end);
    return arc;
  }

  /// How far a place on an arc is displaced along the tangent at its end, as a share of that
  /// tangent: (1 - cos(share * turn)) / (1 - cos(turn)).
  static double along_tangent(double turn, double share) {
    const double ratio = std::sin(share * turn / 2) / std::sin(turn / 2);
    return ratio * ratio;
  }

  void check_arc(std::size_t i, double turn, double tangent, double radius) {
    const std::vector<Position> arc = arc_at(i, turn, tangent, radius);
    for (const auto& zone : problem_.no_fly_zones) {
      if (is_far(zone, points_[i], tangent)) continue;
      for (std::size_t piece = 1; piece < arc.size(); ++piece) {
        if (route_checker::entry_into(zone, arc[piece - 1], arc[piece]) < 0) continue;
        report(
            RouteRule::Zone,
            "the turn at waypoint {}, which begins {:.0f} m before it, enters the no-fly zone '{}'",
            i, tangent, zone.name);
        break;
      }
    }
    if (off_terrain_) return;
    double height = std::numeric_limits<double>::infinity();
    for (std::size_t piece = 1; piece < arc.size(); ++piece) {
      height = std::min(height, route_checker::lowest_height(ground_, arc[piece - 1], arc[piece]));
    }
    if (!(height >= problem_.minimum_height_above_ground_m - tolerances_.height_m)) {
      report(RouteRule::Ground,
             "the turn at waypoint {}, which begins {:.0f} m before it, comes down to {:.1f} m "
             "above the ground; the minimum is {:.1f} m",
             i, tangent, height, problem_.minimum_height_above_ground_m);
    }
  }

  void check_claims() {
    if (!(std::abs(length_m_ - route_.length_m) <= tolerances_.length_m)) {
      report(RouteRule::Length, "the claimed length is {:.1f} m; the edges are {:.1f} m long",
             route_.length_m, length_m_);
    }
    const double longest = kLongestRoute * (ground_.rows * ground_.north_spacing_m +
                                            ground_.columns * ground_.east_spacing_m);
    if (!(length_m_ <= longest)) {
      report(RouteRule::Length, "the route is {:.0f} m long; on this terrain {:.0f} m are the most",
             length_m_, longest);
      return;
    }
    if (off_terrain_) return;
    if (!(std::abs(lowest_m_ - route_.lowest_height_above_ground_m) <= tolerances_.height_m)) {
      report(RouteRule::LowestHeight,
             "the claimed lowest height above ground is {:.1f} m; it is {:.1f} m",
             route_.lowest_height_above_ground_m, lowest_m_);
    }
    check_exposure();
    check_missiles();
  }

  void check_exposure() {
    double exposure = 0;
    for (std::size_t i = 1; i < points_.size(); ++i) {
      for (const auto& site : problem_.radar_sites) {
        exposure += route_checker::exposure(ground_, site, points_[i - 1], points_[i]);
      }
    }
    const double tolerance = tolerances_.exposure_m + tolerances_.exposure_share * exposure;
    if (!(std::abs(exposure - route_.radar_exposure) <= tolerance)) {
      report(RouteRule::Exposure, "the claimed exposure is {:.0f} m; it is {:.0f} m",
             route_.radar_exposure, exposure);
    }
    if (problem_.exposure_cap_m > 0 && !(exposure <= problem_.exposure_cap_m + tolerance)) {
      report(RouteRule::Exposure, "the exposure is {:.0f} m; the cap is {:.0f} m", exposure,
             problem_.exposure_cap_m);
    }
  }

  void check_missiles() {
    double kills = 0;
    for (std::size_t i = 1; i < points_.size(); ++i) {
      for (const auto& site : problem_.missile_sites) {
        const double metres =
            route_checker::metres_in_danger(ground_, site, points_[i - 1], points_[i]);
        kills += site.kills_per_second * metres / problem_.limits.speed_m_s;
      }
    }
    const double tolerance = tolerances_.kills + tolerances_.kills_share * kills;
    if (!(std::abs(kills - route_.expected_kills) <= tolerance)) {
      report(RouteRule::Missiles, "the claimed number of expected kills is {:.3f}; it is {:.3f}",
             route_.expected_kills, kills);
    }
  }

  const Problem& problem_;
  const std::vector<Position>& points_;
  const Route& route_;
  const HeightGrid& ground_;
  const RouteTolerances& tolerances_;
  std::vector<RouteViolation> violations_;
  bool off_terrain_ = false;
  double length_m_ = 0;
  double lowest_m_ = std::numeric_limits<double>::infinity();
};

}  // namespace

std::string_view to_string(RouteRule rule) noexcept {
  switch (rule) {
    case RouteRule::Finite:
      return "finite numbers";
    case RouteRule::Continuity:
      return "continuity";
    case RouteRule::Start:
      return "start";
    case RouteRule::Goal:
      return "goal";
    case RouteRule::Terrain:
      return "terrain";
    case RouteRule::Zone:
      return "no-fly zone";
    case RouteRule::Ground:
      return "height above ground";
    case RouteRule::Altitude:
      return "maximum altitude";
    case RouteRule::Climb:
      return "climb angle";
    case RouteRule::Turn:
      return "turn radius";
    case RouteRule::Length:
      return "claimed length";
    case RouteRule::LowestHeight:
      return "claimed lowest height";
    case RouteRule::Exposure:
      return "exposure";
    case RouteRule::Missiles:
      return "claimed expected kills";
  }
  return "unknown rule";
}

std::vector<RouteViolation> check_route(const Problem& problem, const Route& route,
                                        const HeightGrid& ground,
                                        const RouteTolerances& tolerances) {
  const auto posts = static_cast<std::size_t>(std::max(0, ground.rows)) *
                     static_cast<std::size_t>(std::max(0, ground.columns));
  if (ground.rows < 2 || ground.columns < 2 || posts != ground.heights_m.size() ||
      !(ground.north_spacing_m > 0 && ground.east_spacing_m > 0)) {
    throw InvalidArgument(
        fmt::format("a route cannot be checked over {} x {} posts with {} heights", ground.rows,
                    ground.columns, ground.heights_m.size()));
  }
  return Check(problem, route, ground, tolerances).run();
}

}  // namespace skein::navigation
