#include "traffic/advisory.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <vector>

namespace reconnaissance {
namespace {

constexpr double kPreferred_rad = 15 * std::numbers::pi / 180;  // persistence_preferred_hdir
constexpr double kRecoveryStep = 0.1;                           // ca_factor

bool conflict(const TrafficState& own, std::span<const TrafficState> others,
              const WellClearVolume& volume, double within_s) {
  return std::any_of(others.begin(), others.end(), [&](const TrafficState& other) {
    return violation(own, other, volume, within_s).has_value();
  });
}

/// The other may turn back at the same time.
constexpr WellClearVolume kWidened{1.5 * kEnRoute.distance_m, kEnRoute.height_m, kEnRoute.tau_s};

const Manoeuvre* least_change(const std::vector<Manoeuvre>& tried, auto&& allowed) {
  const Manoeuvre* best = nullptr;
  for (const Manoeuvre& one : tried) {
    if (!one.free || !allowed(one)) continue;
    if (!best || std::abs(one.change) < std::abs(best->change)) best = &one;
  }
  return best;
}

/// How often the volume has to be made smaller so that the manoeuvre keeps outside of it.
int reductions(const Manoeuvre& one) {
  if (one.nmac_multiple <= 1) return std::numeric_limits<int>::max();
  if (one.volume_multiple >= 1) return 0;
  return static_cast<int>(std::ceil(std::log(one.volume_multiple) / std::log1p(-kRecoveryStep)));
}

bool recovers_better(const Manoeuvre& one, const Manoeuvre& other) {
  if (reductions(one) != reductions(other)) return reductions(one) < reductions(other);
  if (one.nmac_multiple <= 1 && one.nmac_multiple != other.nmac_multiple) {
    return one.nmac_multiple > other.nmac_multiple;
  }
  if (one.clear_s != other.clear_s) return one.clear_s < other.clear_s;
  return std::abs(one.change) < std::abs(other.change);
}

const Manoeuvre& best_recovery(const std::vector<Manoeuvre>& tried) {
  return *std::min_element(tried.begin(), tried.end(), recovers_better);
}

}  // namespace

ResolutionAdvisory BandsAvoider::advise(const TrafficState& own,
                                        std::span<const TrafficState> others,
                                        double route_course_rad, AlertLevel alert,
                                        const MayFly& may_fly) {
  if (!avoiding_) {
    // An alert outlives its cause: where the route leads clear, it is flown.
    const bool route_conflicts =
        conflict(on_course(own, route_course_rad), others, kEnRoute, limits_.look_ahead_s);
    avoiding_ =
        alert >= AlertLevel::Warning || (alert >= AlertLevel::Corrective && route_conflicts);
  } else if (!conflict(on_course(own, route_course_rad), others, kWidened, limits_.look_ahead_s)) {
    avoiding_ = false;
  }
  if (avoiding_) return resolve(own, others, may_fly);
  side_ = Side::None;
  return {};
}

/// To the side that is nearer.
std::optional<double> BandsAvoider::least_turn(const std::vector<Manoeuvre>& courses,
                                               const MayFly& may_fly) {
  const auto* right =
      least_change(courses, [&](const auto& one) { return one.change >= 0 && may_fly(one.value); });
  const auto* left =
      least_change(courses, [&](const auto& one) { return one.change <= 0 && may_fly(one.value); });
  if (!right && !left) return std::nullopt;
  const double bonus = side_ == Side::None ? 0 : kPreferred_rad;
  const double to_right = right ? right->change - (side_ == Side::Right ? bonus : 0) : 1e9;
  const double to_left = left ? -left->change - (side_ == Side::Left ? bonus : 0) : 1e9;
  const bool turn_right = to_right <= to_left + kCourseStep_rad / 2;
  side_ = turn_right ? Side::Right : Side::Left;
  return (turn_right ? right : left)->value;
}

ResolutionAdvisory BandsAvoider::resolve(const TrafficState& own,
                                         std::span<const TrafficState> others,
                                         const MayFly& may_fly) {
  const auto courses = course_bands(own, others, kEnRoute, limits_);
  if (const auto course = least_turn(courses, may_fly)) return {course, {}, false};
  const auto climbs = climb_bands(own, others, kEnRoute, limits_);
  if (const auto* climb = least_change(climbs, [](const auto&) { return true; })) {
    return {{}, climb->value, false};
  }
  if (const auto course = least_turn(courses, [](double) { return true; }))
    return {course, {}, false};
  const Manoeuvre& course = best_recovery(courses);
  const Manoeuvre& climb = best_recovery(climbs);
  if (recovers_better(climb, course)) return {{}, climb.value, true};
  return {course.value, {}, true};
}

ResolutionAdvisory PotentialFieldAvoider::advise(const TrafficState& own,
                                                 std::span<const TrafficState> others,
                                                 double route_course_rad) const {
  constexpr ManoeuvreLimits kLimits;
  if (!conflict(on_course(own, route_course_rad), others, kEnRoute, kLimits.look_ahead_s) &&
      !conflict(own, others, kEnRoute, kLimits.look_ahead_s)) {
    return {};
  }
  double north = std::cos(route_course_rad);
  double east = std::sin(route_course_rad);
  double up = 0;
  for (const TrafficState& other : others) {
    const double s_north = own.place.north_m - other.place.north_m;
    const double s_east = own.place.east_m - other.place.east_m;
    const double v_north = own.north_m_s - other.north_m_s;
    const double v_east = own.east_m_s - other.east_m_s;
    const double squared_speed = v_north * v_north + v_east * v_east;
    const double closing = s_north * v_north + s_east * v_east;
    const double closest_s =
        squared_speed > 0 ? std::clamp(-closing / squared_speed, 0.0, kLimits.look_ahead_s) : 0;
    double away_north = s_north + closest_s * v_north;
    double away_east = s_east + closest_s * v_east;
    const double closest_m = std::hypot(away_north, away_east);
    if (closest_m < 1) {
      // Right of the own course.
      away_north = -own.east_m_s;
      away_east = own.north_m_s;
    }
    const double length = std::hypot(away_north, away_east);
    if (length == 0) continue;
    // 2 at the edge of the volume half a look-ahead away.
    const double nearness = kEnRoute.distance_m / std::max(closest_m, kEnRoute.distance_m / 10);
    const double soon = kLimits.look_ahead_s / 2 / std::max(closest_s, 1.0);
    const double strength = 2 * nearness * nearness * soon;
    const double range_m = std::max(std::hypot(s_north, s_east), 1.0);
    north += strength * (away_north / length + s_east / range_m);
    east += strength * (away_east / length - s_north / range_m);
    if (violation(own, other, kEnRoute, kEnRouteAlerts[0].raised_s)) {
      const double above_m =
          own.place.height_m - other.place.height_m + closest_s * (own.up_m_s - other.up_m_s);
      up += (above_m >= 0 ? 1 : -1) * strength;
    }
  }
  ResolutionAdvisory advisory{std::atan2(east, north), {}, false};
  if (up != 0) advisory.climb_m_s = up > 0 ? kLimits.greatest_climb_m_s : kLimits.least_climb_m_s;
  return advisory;
}

}  // namespace reconnaissance
