#include "planning/dubins_length.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace reconnaissance {
namespace {

constexpr double kCircle = 2 * std::numbers::pi;
// Centres no farther apart, in radii, are one: the direction from one to the other is rounding.
constexpr double kOneCircle = 1e-7;

/// From 0 to a full circle; what rounding has made nearly one is none.
double turn(double angle_rad) {
  const double angle = angle_rad - kCircle * std::floor(angle_rad / kCircle);
  return angle > kCircle - 1e-9 ? 0 : angle;
}

}  // namespace

double dubins_length_m(const RoutePose& from, const RoutePose& to, double radius_m) {
  // In radii, with the goal ahead. Courses grow to the right; here angles grow to the left.
  const double north = (to.north_m - from.north_m) / radius_m;
  const double east = (to.east_m - from.east_m) / radius_m;
  const double d = std::hypot(north, east);
  const double ahead_rad = std::atan2(east, north);
  const double a = turn(ahead_rad - from.course_rad);
  const double b = turn(ahead_rad - to.course_rad);
  const double sin_a = std::sin(a), cos_a = std::cos(a);
  const double sin_b = std::sin(b), cos_b = std::cos(b);
  const double cos_ab = std::cos(a - b);

  double best = std::numeric_limits<double>::infinity();
  const auto offer = [&](double first, double middle, double last) {
    best = std::min(best, turn(first) + middle + turn(last));
  };
  {  // LSL: the straight joins the centres of both left circles.
    const double along = d + sin_a - sin_b;
    const double across = cos_b - cos_a;
    const double straight = std::hypot(along, across);
    const double slope = straight > kOneCircle ? std::atan2(across, along) : a;
    offer(slope - a, straight, b - slope);
  }
  {  // RSR
    const double along = d - sin_a + sin_b;
    const double across = cos_a - cos_b;
    const double straight = std::hypot(along, across);
    const double slope = straight > kOneCircle ? std::atan2(across, along) : a;
    offer(a - slope, straight, slope - b);
  }
  if (const double squared = d * d - 2 + 2 * cos_ab + 2 * d * (sin_a + sin_b); squared >= 0) {
    // LSR: the straight is an inner tangent.
    const double straight = std::sqrt(squared);
    const double slope = std::atan2(-cos_a - cos_b, d + sin_a + sin_b) - std::atan2(-2.0, straight);
    offer(slope - a, straight, slope - b);
  }
  if (const double squared = d * d - 2 + 2 * cos_ab - 2 * d * (sin_a + sin_b); squared >= 0) {
    // RSL
    const double straight = std::sqrt(squared);
    const double slope = std::atan2(cos_a + cos_b, d - sin_a - sin_b) - std::atan2(2.0, straight);
    offer(a - slope, straight, b - slope);
  }
  if (const double cosine = (6 - d * d + 2 * cos_ab + 2 * d * (sin_a - sin_b)) / 8;
      std::abs(cosine) <= 1) {
    // RLR: three circles that touch.
    const double middle = turn(kCircle - std::acos(cosine));
    const double first = turn(a - std::atan2(cos_a - cos_b, d - sin_a + sin_b) + middle / 2);
    offer(first, middle, a - b - first + middle);
  }
  if (const double cosine = (6 - d * d + 2 * cos_ab - 2 * d * (sin_a - sin_b)) / 8;
      std::abs(cosine) <= 1) {
    // LRL
    const double middle = turn(kCircle - std::acos(cosine));
    const double first = turn(std::atan2(cos_b - cos_a, d + sin_a - sin_b) - a + middle / 2);
    offer(first, middle, b - a - first + middle);
  }
  return best * radius_m;
}

}  // namespace reconnaissance
