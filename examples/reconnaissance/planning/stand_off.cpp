#include "planning/stand_off.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace reconnaissance {
namespace {

// A follower of a circle that moves lags behind by about as much.
constexpr double kAhead_s = 5;
// Between a circle and a weapon's reach: the guidance swings over, and the wind blows.
constexpr double kRoom_m = 200;
constexpr int kMoves = 20;

bool is_clear(const Circle& circle, const ThreatDisc& weapon) {
  return map_distance_m(circle.centre, weapon) >= weapon.radius_m + circle.radius_m;
}

bool is_on_the_right(const Local& place, const Motion& aircraft) {
  const double north = place.north_m - aircraft.north_m, east = place.east_m - aircraft.east_m;
  return east * aircraft.north_m_s - north * aircraft.east_m_s >= 0;
}

double furthest_m(const Circle& circle, const Motion& target) {
  return map_distance_m(circle.centre, target) + circle.radius_m;
}

}  // namespace

Circle circle_about(const StandOffTask& task) {
  const Motion& target = task.target;
  const Local centre{target.north_m + kAhead_s * target.north_m_s,
                     target.east_m + kAhead_s * target.east_m_s, 0};
  return {centre, task.radius_m, is_on_the_right(centre, task.aircraft)};
}

std::optional<Circle> circle_beside(const StandOffTask& task) {
  Circle circle = circle_about(task);
  // Away from one weapon may be towards another one.
  for (int move = 0; move < kMoves; ++move) {
    const auto weapon = std::ranges::find_if_not(
        task.weapons, [&](const ThreatDisc& each) { return is_clear(circle, each); });
    if (weapon == task.weapons.end()) {
      if (furthest_m(circle, task.target) > task.greatest_distance_m) return std::nullopt;
      // The other way it would be joined by a wide turn, which leads into reach.
      circle.clockwise = is_on_the_right(circle.centre, task.aircraft);
      return circle;
    }
    const double away_m = weapon->radius_m + circle.radius_m + kRoom_m;
    const double north = circle.centre.north_m - weapon->north_m;
    const double east = circle.centre.east_m - weapon->east_m;
    const double length = std::hypot(north, east);
    if (length < 1) return std::nullopt;
    circle.centre.north_m = weapon->north_m + away_m / length * north;
    circle.centre.east_m = weapon->east_m + away_m / length * east;
  }
  return std::nullopt;
}

std::optional<std::string> flaw_of(const Circle& circle, const StandOffTask& task) {
  if (!(circle.radius_m >= task.turn_radius_m))
    return fmt::format("its radius is {:.0f} m, and the aircraft turns with {:.0f}",
                       circle.radius_m, task.turn_radius_m);
  const double furthest = furthest_m(circle, task.target);
  // A lead over a fast target is no flaw.
  const double lead_m = kAhead_s * std::hypot(task.target.north_m_s, task.target.east_m_s);
  if (!(furthest <= task.greatest_distance_m + lead_m))
    return fmt::format("the target is up to {:.0f} m away, and can be seen as wanted from {:.0f}",
                       furthest, task.greatest_distance_m);
  for (const ThreatDisc& weapon : task.weapons)
    if (!is_clear(circle, weapon)) return "it leads into the reach of a weapon";
  return std::nullopt;
}

std::optional<Circle> waiting_circle(const Local& aircraft,
                                     const std::vector<ThreatDisc>& weapons) {
  constexpr double kRadius_m = 2500, kNear_m = 8500, kAway_m = 500;
  std::vector<ThreatDisc> wide = weapons;
  for (ThreatDisc& each : wide) each.radius_m += kRadius_m + kAway_m;
  const Local runway, centre = out_of_reach(runway, wide);
  const bool level =
      map_distance_m(aircraft, runway) < kNear_m && map_distance_m(centre, runway) < kNear_m;
  if (!level || is_within(centre, wide) || hazard_of_leg(aircraft, centre, weapons, 1) > 0)
    return std::nullopt;
  return Circle{centre, kRadius_m, true};
}

double greatest_distance_m(double ground_sample_m, double pixel_rad, double height_m) {
  // The longer side of a pixel is slant range squared times its angle, over the height.
  const double squared = ground_sample_m * height_m / pixel_rad - height_m * height_m;
  return squared > 0 ? std::sqrt(squared) : 0;
}

}  // namespace reconnaissance
