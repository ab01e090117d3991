#include "planning/dubins_length.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>

namespace reconnaissance {
namespace {

constexpr double kCircle = 2 * std::numbers::pi;
// Centres no farther apart, in radii, are one: the direction from one to the other is rounding.
constexpr double kOneCircle = 1e-7;
// Turns of which nothing is seen, and the longest that has one corner.
constexpr double kNoTurn_rad = 0.005;
constexpr double kLongestPiece_rad = std::numbers::pi / 3;

/// From 0 to a full circle; what rounding has made nearly one is none.
double turn(double angle_rad) {
  const double angle = angle_rad - kCircle * std::floor(angle_rad / kCircle);
  return angle > kCircle - 1e-9 ? 0 : angle;
}

/// Where a part of a way leads.
enum class Side { Left, Straight, Right };

/// The three parts of a way, in radii.
struct Word {
  std::array<double, 3> parts{};
  std::array<Side, 3> sides{};

  double length() const { return parts[0] + parts[1] + parts[2]; }
};

Word shortest(const RoutePose& from, const RoutePose& to, double radius_m) {
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

  Word best{{std::numeric_limits<double>::infinity(), 0, 0}, {}};
  const auto offer = [&](Side first_side, double first, Side middle_side, double middle,
                         Side last_side, double last) {
    const Word word{{turn(first), middle, turn(last)}, {first_side, middle_side, last_side}};
    if (word.length() < best.length()) best = word;
  };
  constexpr Side kLeft = Side::Left, kStraight = Side::Straight, kRight = Side::Right;
  {  // LSL: the straight joins the centres of both left circles.
    const double along = d + sin_a - sin_b;
    const double across = cos_b - cos_a;
    const double straight = std::hypot(along, across);
    const double slope = straight > kOneCircle ? std::atan2(across, along) : a;
    offer(kLeft, slope - a, kStraight, straight, kLeft, b - slope);
  }
  {  // RSR
    const double along = d - sin_a + sin_b;
    const double across = cos_a - cos_b;
    const double straight = std::hypot(along, across);
    const double slope = straight > kOneCircle ? std::atan2(across, along) : a;
    offer(kRight, a - slope, kStraight, straight, kRight, slope - b);
  }
  if (const double squared = d * d - 2 + 2 * cos_ab + 2 * d * (sin_a + sin_b); squared >= 0) {
    // LSR: the straight is an inner tangent.
    const double straight = std::sqrt(squared);
    const double slope = std::atan2(-cos_a - cos_b, d + sin_a + sin_b) - std::atan2(-2.0, straight);
    offer(kLeft, slope - a, kStraight, straight, kRight, slope - b);
  }
  if (const double squared = d * d - 2 + 2 * cos_ab - 2 * d * (sin_a + sin_b); squared >= 0) {
    // RSL
    const double straight = std::sqrt(squared);
    const double slope = std::atan2(cos_a + cos_b, d - sin_a - sin_b) - std::atan2(2.0, straight);
    offer(kRight, a - slope, kStraight, straight, kLeft, b - slope);
  }
  if (const double cosine = (6 - d * d + 2 * cos_ab + 2 * d * (sin_a - sin_b)) / 8;
      std::abs(cosine) <= 1) {
    // RLR: three circles that touch.
    const double middle = turn(kCircle - std::acos(cosine));
    const double first = turn(a - std::atan2(cos_a - cos_b, d - sin_a + sin_b) + middle / 2);
    offer(kRight, first, kLeft, middle, kRight, a - b - first + middle);
  }
  if (const double cosine = (6 - d * d + 2 * cos_ab - 2 * d * (sin_a - sin_b)) / 8;
      std::abs(cosine) <= 1) {
    // LRL
    const double middle = turn(kCircle - std::acos(cosine));
    const double first = turn(std::atan2(cos_b - cos_a, d + sin_a - sin_b) - a + middle / 2);
    offer(kLeft, first, kRight, middle, kLeft, b - a - first + middle);
  }
  return best;
}

}  // namespace

double dubins_length_m(const RoutePose& from, const RoutePose& to, double radius_m) {
  return shortest(from, to, radius_m).length() * radius_m;
}

std::vector<RoutePose> dubins_corners(const RoutePose& from, const RoutePose& to, double radius_m) {
  const Word word = shortest(from, to, radius_m);
  std::vector<RoutePose> corners;
  RoutePose here = from;
  const auto advance = [&](double way_m) {
    here.north_m += way_m * std::cos(here.course_rad);
    here.east_m += way_m * std::sin(here.course_rad);
  };
  for (std::size_t i = 0; i < word.parts.size(); ++i) {
    if (word.sides[i] == Side::Straight) {
      advance(word.parts[i] * radius_m);
      continue;
    }
    if (word.parts[i] < kNoTurn_rad) continue;
    const double pieces = std::ceil(word.parts[i] / kLongestPiece_rad);
    const double turn_rad = word.parts[i] / pieces;
    for (int piece = 0; piece < static_cast<int>(pieces); ++piece) {
      advance(radius_m * std::tan(turn_rad / 2));
      here.course_rad += word.sides[i] == Side::Left ? -turn_rad : turn_rad;
      corners.push_back(here);
      advance(radius_m * std::tan(turn_rad / 2));
    }
  }
  return corners;
}

}  // namespace reconnaissance
