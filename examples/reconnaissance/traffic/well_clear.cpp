#include "traffic/well_clear.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace reconnaissance {
namespace {

constexpr double kEver = std::numeric_limits<double>::infinity();

struct Relative {
  double north_m, east_m, up_m;
  double north_m_s, east_m_s, up_m_s;

  Relative(const TrafficState& own, const TrafficState& other)
      : north_m(own.place.north_m - other.place.north_m),
        east_m(own.place.east_m - other.place.east_m),
        up_m(own.place.height_m - other.place.height_m),
        north_m_s(own.north_m_s - other.north_m_s),
        east_m_s(own.east_m_s - other.east_m_s),
        up_m_s(own.up_m_s - other.up_m_s) {}

  double squared_distance() const { return north_m * north_m + east_m * east_m; }
  double squared_speed() const { return north_m_s * north_m_s + east_m_s * east_m_s; }
  double closing() const { return north_m * north_m_s + east_m * east_m_s; }
};

std::optional<Period> from_now(double in_s, double out_s) {
  if (out_s < 0) return std::nullopt;
  return Period{std::max(in_s, 0.0), out_s};
}

/// Both roots of a t² + 2 h t + c with a ≠ 0, the smaller first; without cancellation.
std::optional<Period> roots(double a, double h, double c) {
  const double discriminant = h * h - a * c;
  if (discriminant < 0) return std::nullopt;
  const double q = -(h + std::copysign(std::sqrt(discriminant), h));
  if (q == 0) return Period{0, 0};
  return Period{std::min(q / a, c / q), std::max(q / a, c / q)};
}

std::optional<Period> horizontal_violation(const Relative& r, const WellClearVolume& volume) {
  const double squared_threshold = volume.distance_m * volume.distance_m;
  const double a = r.squared_speed();
  const bool near = r.squared_distance() <= squared_threshold;
  if (a == 0) return near ? std::optional(Period{0, kEver}) : std::nullopt;
  const double c = r.squared_distance() - squared_threshold;
  if (!near && r.closing() >= 0) return std::nullopt;
  const auto inside_distance = roots(a, r.closing(), c);
  if (!inside_distance) return std::nullopt;
  const auto inside_tau =
      roots(a, r.closing() + volume.tau_s * a / 2, c + volume.tau_s * r.closing());
  // Where the distance is reached, modified tau is 0: its root is there, but for rounding.
  const double in_s = (inside_tau ? inside_tau : inside_distance)->in_s;
  return from_now(in_s, inside_distance->out_s);
}

std::optional<Period> vertical_violation(const Relative& r, double height_m) {
  if (r.up_m_s == 0) {
    return std::abs(r.up_m) <= height_m ? std::optional(Period{0, kEver}) : std::nullopt;
  }
  const double one = (-height_m - r.up_m) / r.up_m_s;
  const double two = (height_m - r.up_m) / r.up_m_s;
  return from_now(std::min(one, two), std::max(one, two));
}

}  // namespace

double TrafficState::course_rad() const { return std::atan2(east_m_s, north_m_s); }

double TrafficState::ground_speed_m_s() const { return std::hypot(north_m_s, east_m_s); }

TrafficState straight_on(const TrafficState& state, double seconds) {
  TrafficState later = state;
  later.place.north_m += state.north_m_s * seconds;
  later.place.east_m += state.east_m_s * seconds;
  later.place.height_m += state.up_m_s * seconds;
  return later;
}

TrafficState on_course(TrafficState state, double course_rad) {
  const double speed_m_s = state.ground_speed_m_s();
  state.north_m_s = speed_m_s * std::cos(course_rad);
  state.east_m_s = speed_m_s * std::sin(course_rad);
  return state;
}

bool violates(const TrafficState& own, const TrafficState& other, const WellClearVolume& volume) {
  const Relative r(own, other);
  if (std::abs(r.up_m) > volume.height_m) return false;
  const double squared_threshold = volume.distance_m * volume.distance_m;
  if (r.squared_distance() <= squared_threshold) return true;
  if (r.closing() >= 0) return false;
  const double closest = r.squared_distance() - r.closing() * r.closing() / r.squared_speed();
  const double tau_s = (squared_threshold - r.squared_distance()) / r.closing();
  return closest <= squared_threshold && tau_s <= volume.tau_s;
}

std::optional<Period> violation(const TrafficState& own, const TrafficState& other,
                                const WellClearVolume& volume, double look_ahead_s) {
  const Relative r(own, other);
  const auto vertical = vertical_violation(r, volume.height_m);
  if (!vertical) return std::nullopt;
  const auto horizontal = horizontal_violation(r, volume);
  if (!horizontal) return std::nullopt;
  const Period both{std::max(horizontal->in_s, vertical->in_s),
                    std::min({horizontal->out_s, vertical->out_s, look_ahead_s})};
  if (both.in_s > both.out_s) return std::nullopt;
  return both;
}

double least_separation(const TrafficState& own, const TrafficState& other, double distance_m,
                        double height_m, double look_ahead_s) {
  const Relative r(own, other);
  const auto separation = [&](double t) {
    return std::max(std::hypot(r.north_m + t * r.north_m_s, r.east_m + t * r.east_m_s) / distance_m,
                    std::abs(r.up_m + t * r.up_m_s) / height_m);
  };
  // Either one is least by itself, or both are equal, or it is one of the ends.
  double least = std::min(separation(0), separation(look_ahead_s));
  const auto consider = [&](double t) {
    if (t > 0 && t < look_ahead_s) least = std::min(least, separation(t));
  };
  if (r.squared_speed() > 0) consider(-r.closing() / r.squared_speed());
  if (r.up_m_s != 0) consider(-r.up_m / r.up_m_s);
  const double squared_ratio = (distance_m * distance_m) / (height_m * height_m);
  const double a = r.squared_speed() - squared_ratio * r.up_m_s * r.up_m_s;
  const double h = r.closing() - squared_ratio * r.up_m * r.up_m_s;
  const double c = r.squared_distance() - squared_ratio * r.up_m * r.up_m;
  if (a != 0) {
    if (const auto equal = roots(a, h, c)) {
      consider(equal->in_s);
      consider(equal->out_s);
    }
  } else if (h != 0) {
    consider(-c / (2 * h));
  }
  return least;
}

}  // namespace reconnaissance
