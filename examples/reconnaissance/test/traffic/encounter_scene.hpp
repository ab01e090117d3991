#pragma once

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <functional>
#include <numbers>
#include <vector>

#include "random.hpp"
#include "traffic/advisory.hpp"

// Encounters of an aircraft with one intruder, flown in steps by what detect and avoid advises.
namespace reconnaissance {

constexpr double kStep_s = 0.1;

inline TrafficState flying(Local place, double course_rad, double speed_m_s, double up_m_s = 0) {
  return {place, speed_m_s * std::cos(course_rad), speed_m_s * std::sin(course_rad), up_m_s};
}

/// Follows advisories with the limits that the bands assume, otherwise the route.
inline TrafficState steered(TrafficState state, const ResolutionAdvisory& advisory,
                            double route_rad) {
  const ManoeuvreLimits limits;
  const double wanted_rad = advisory.course_rad.value_or(route_rad);
  const double error_rad = std::remainder(wanted_rad - state.course_rad(), 2 * std::numbers::pi);
  const double most_rad = limits.turn_rate_rad_s * kStep_s;
  state = flying(state.place, state.course_rad() + std::clamp(error_rad, -most_rad, most_rad),
                 state.ground_speed_m_s(), state.up_m_s);
  const double most_m_s = limits.vertical_acceleration_m_s2 * kStep_s;
  state.up_m_s += std::clamp(advisory.climb_m_s.value_or(0) - state.up_m_s, -most_m_s, most_m_s);
  return straight_on(state, kStep_s);
}

/// Of the surveillance of traffic, standard deviations on each axis.
struct SurveillanceErrors {
  double place_m = 0, height_m = 0, speed_m_s = 0;
};

/// One aircraft's detect and avoid, once a second.
template <class Avoider>
class Equipment {
 public:
  explicit Equipment(const SurveillanceErrors& errors = {}) : errors_(errors) {}

  ResolutionAdvisory advise(const TrafficState& own, const TrafficState& truth, double route_rad) {
    TrafficState seen = truth;
    seen.place.north_m += errors_.place_m * random_.normal();
    seen.place.east_m += errors_.place_m * random_.normal();
    seen.place.height_m += errors_.height_m * random_.normal();
    seen.north_m_s += errors_.speed_m_s * random_.normal();
    seen.east_m_s += errors_.speed_m_s * random_.normal();
    seen.up_m_s += errors_.speed_m_s / 4 * random_.normal();
    const std::vector others{seen};
    const AlertLevel level = alert_.assess(own, seen, now_s_++);
    if constexpr (requires { avoider_.advise(own, others, route_rad, level); }) {
      return avoider_.advise(own, others, route_rad, level);
    } else {
      return avoider_.advise(own, others, route_rad);
    }
  }

 private:
  SurveillanceErrors errors_;
  Random random_{14};
  Avoider avoider_;
  Alert alert_;
  double now_s_ = 0;
};

struct Flown {
  double nmac_multiple = 1e9;
  double violated_s = 0;
  bool well_clear_at_end = false;
  bool on_course_at_end = false;
};

template <class Avoider>
Flown fly(TrafficState own, TrafficState other, double seconds,
          const std::function<TrafficState(const TrafficState&, const TrafficState&)>& other_flies,
          const SurveillanceErrors& errors = {}) {
  const double route_rad = own.course_rad();
  Flown flown;
  Equipment<Avoider> equipment(errors);
  ResolutionAdvisory advisory;
  for (int i = 0; i < seconds / kStep_s; ++i) {
    if (i % 10 == 0) advisory = equipment.advise(own, other, route_rad);
    const TrafficState before = own;
    own = steered(own, advisory, route_rad);
    other = other_flies(other, before);
    flown.nmac_multiple =
        std::min(flown.nmac_multiple, least_separation(own, other, kNearMidAirCollision.distance_m,
                                                       kNearMidAirCollision.height_m, 0));
    const bool violated = violates(own, other, kEnRoute);
    flown.violated_s += violated ? kStep_s : 0;
    flown.well_clear_at_end = !violated;
    const double turned = std::remainder(own.course_rad() - route_rad, 2 * std::numbers::pi);
    flown.on_course_at_end = std::abs(turned) < 0.02;
  }
  return flown;
}

inline TrafficState undisturbed(const TrafficState& other, const TrafficState&) {
  return straight_on(other, kStep_s);
}

struct Pair {
  TrafficState own, other;
};

/// They come within 900 m and 100 m of height of each other after 90 to 150 s.
inline Pair colliding(Random& random) {
  const TrafficState own = flying({0, 0, 1000}, 2 * std::numbers::pi * random.uniform(), 60);
  const double closest_s = 90 + 60 * random.uniform();
  TrafficState there = straight_on(own, closest_s);
  const double bearing = 2 * std::numbers::pi * random.uniform();
  const double miss_m = 900 * random.uniform();
  there.place.north_m += miss_m * std::cos(bearing);
  there.place.east_m += miss_m * std::sin(bearing);
  there.place.height_m += 200 * (random.uniform() - 0.5);
  there = flying(there.place, 2 * std::numbers::pi * random.uniform(), 30 + 100 * random.uniform(),
                 random.happens(0.5) ? 0 : 6 * (random.uniform() - 0.5));
  return {own, straight_on(there, -closest_s)};
}

struct Summary {
  int collisions = 0, violations = 0, recovered = 0, back = 0;
  double longest_violation_s = 0;
};

template <class Avoider>
Summary summary(int encounters, const SurveillanceErrors& errors = {}) {
  Random random(10);
  Summary all;
  for (int i = 0; i < encounters; ++i) {
    Pair pair = colliding(random);
    while (violates(pair.own, pair.other, kEnRoute)) pair = colliding(random);
    const Flown flown = fly<Avoider>(pair.own, pair.other, 400, undisturbed, errors);
    all.collisions += flown.nmac_multiple < 1;
    all.violations += flown.violated_s > 0;
    all.recovered += flown.well_clear_at_end;
    all.back += flown.on_course_at_end;
    all.longest_violation_s = std::max(all.longest_violation_s, flown.violated_s);
  }
  return all;
}

}  // namespace reconnaissance
