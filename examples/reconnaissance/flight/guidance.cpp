#include "guidance.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "angles.hpp"
#include "point_mass.hpp"

namespace reconnaissance {
namespace {

// A slower aircraft cannot be steered by a bank.
constexpr double kLeastGuided_m_s = 1;
// A carrot's bank for each radian of its angle.
constexpr double kCarrotGain = 1.5;
// Sharper turns than this are led as this one: tan(eta / 2) grows beyond all bounds.
constexpr double kSharpest_rad = 2.4;

double speed_of(const Motion& motion) {
  return std::max(std::hypot(motion.north_m_s, motion.east_m_s), kLeastGuided_m_s);
}

/// The bank for a lateral acceleration towards a point at that distance.
double bank_towards(const Motion& motion, double north_m, double east_m, double distance_m) {
  const double speed = speed_of(motion);
  const double eta = std::clamp(
      wrapped(std::atan2(east_m, north_m) - std::atan2(motion.east_m_s, motion.north_m_s)),
      -std::numbers::pi / 2, std::numbers::pi / 2);
  return std::atan(2 * speed * speed / distance_m * std::sin(eta) / kGravity_m_s2);
}

}  // namespace

double l1_distance_m(const L1& tuning, double speed_m_s) {
  return std::max(tuning.least_distance_m,
                  tuning.damping * tuning.period_s * speed_m_s / std::numbers::pi);
}

Along along(const Line& line, const Motion& motion) {
  const double north = line.to.north_m - line.from.north_m;
  const double east = line.to.east_m - line.from.east_m;
  Along result;
  result.length_m = std::hypot(north, east);
  result.course_rad = course(std::atan2(east, north));
  const double cosine = std::cos(result.course_rad), sine = std::sin(result.course_rad);
  const double done_north = motion.north_m - line.from.north_m;
  const double done_east = motion.east_m - line.from.east_m;
  result.along_m = done_north * cosine + done_east * sine;
  result.right_m = done_east * cosine - done_north * sine;
  return result;
}

double l1_bank_rad(const L1& tuning, const Motion& motion, const Line& line) {
  const Along here = along(line, motion);
  const double distance = l1_distance_m(tuning, speed_of(motion));
  const double aside = std::abs(here.right_m);
  const double ahead = aside < distance ? std::sqrt(distance * distance - aside * aside) : 0;
  const double cosine = std::cos(here.course_rad), sine = std::sin(here.course_rad);
  return bank_towards(motion, ahead * cosine + here.right_m * sine,
                      ahead * sine - here.right_m * cosine, std::max(distance, aside));
}

double l1_bank_rad(const L1& tuning, const Motion& motion, const Circle& circle) {
  const double north = motion.north_m - circle.centre.north_m;
  const double east = motion.east_m - circle.centre.east_m;
  const double from_centre = std::max(std::hypot(north, east), 1e-3);
  // A reference point nearer than the circle is wide, so that it lies on it.
  const double l1 = std::min(l1_distance_m(tuning, speed_of(motion)), circle.radius_m);
  const double side = circle.clockwise ? 1 : -1;
  const double here = std::atan2(east, north);
  const double outside = from_centre - circle.radius_m;
  double ahead = 0;  // the angle at the centre, from here to the reference point
  if (outside >= l1) {
    ahead = std::acos(circle.radius_m / from_centre);
  } else if (outside > -l1) {
    ahead = std::acos(
        std::clamp((from_centre * from_centre + circle.radius_m * circle.radius_m - l1 * l1) /
                       (2 * from_centre * circle.radius_m),
                   -1.0, 1.0));
  }
  const double there = here + side * ahead;
  const double to_north = circle.radius_m * std::cos(there) - north;
  const double to_east = circle.radius_m * std::sin(there) - east;
  return bank_towards(motion, to_north, to_east, std::max(std::hypot(to_north, to_east), 1.0));
}

double carrot_bank_rad(double ahead_m, const Motion& motion, const Line& line) {
  const Along here = along(line, motion);
  const double wanted = here.course_rad - std::atan2(here.right_m, ahead_m);
  return kCarrotGain * wrapped(wanted - std::atan2(motion.east_m_s, motion.north_m_s));
}

double carrot_bank_rad(double ahead_m, const Motion& motion, const Circle& circle) {
  const double north = motion.north_m - circle.centre.north_m;
  const double east = motion.east_m - circle.centre.east_m;
  const double outside = std::hypot(north, east) - circle.radius_m;
  const double side = circle.clockwise ? 1 : -1;
  const double wanted =
      std::atan2(east, north) + side * (std::numbers::pi / 2 + std::atan2(outside, ahead_m));
  const double speed = speed_of(motion);
  const double turn = std::atan(speed * speed / (kGravity_m_s2 * circle.radius_m));
  return side * turn +
         kCarrotGain * wrapped(wanted - std::atan2(motion.east_m_s, motion.north_m_s));
}

double climb_rad(const Line& line, const Motion& motion, double height_m, double speed_m_s,
                 double time_s) {
  const Along here = along(line, motion);
  const double slope =
      here.length_m > 0 ? (line.to.height_m - line.from.height_m) / here.length_m : 0;
  const double wanted = line.from.height_m + slope * std::clamp(here.along_m, 0.0, here.length_m);
  const double speed = std::max(speed_m_s, kLeastGuided_m_s);
  const bool on_it = here.along_m > 0 && here.along_m < here.length_m;
  return (on_it ? std::atan(slope) : 0) + std::atan((wanted - height_m) / (speed * time_s));
}

double turn_lead_m(double radius_m, const Line& leg, const Line& next) {
  const Along first = along(leg, {}), second = along(next, {});
  const double turn =
      std::min(std::abs(wrapped(second.course_rad - first.course_rad)), kSharpest_rad);
  return std::min({radius_m * std::tan(turn / 2), first.length_m / 2, second.length_m / 2});
}

}  // namespace reconnaissance
