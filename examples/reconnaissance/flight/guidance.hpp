#pragma once

#include "geodesy/local_frame.hpp"

namespace reconnaissance {

/// Where an aircraft is on the map, and how it moves over ground.
struct Motion {
  double north_m = 0;
  double east_m = 0;
  double north_m_s = 0;
  double east_m_s = 0;
};

/// A straight part of a route.
struct Line {
  Local from{};
  Local to{};
};

struct Circle {
  Local centre{};
  double radius_m = 0;
  bool clockwise = true;
};

/// How a follower of paths is tuned.
struct L1 {
  /// The distance ahead at which the reference point lies is damping * period * speed / pi: then
  /// small deviations from a line die out as a second-order system with this period and damping.
  double period_s = 17;
  double damping = 0.75;
  double least_distance_m = 100;
};

double l1_distance_m(const L1& tuning, double speed_m_s);

/// The bank that leads onto a line, and along it, in any wind: the aircraft flies a circular arc,
/// tangential to its motion over ground, to a reference point on the line. Lateral acceleration
/// 2 V^2 / L1 sin(eta), where eta is the angle between the motion and the line of sight to that
/// point. Source: S. Park, J. Deyst, J. How, "A New Nonlinear Guidance Logic for Trajectory
/// Tracking", AIAA 2004-4900. Where the line is further away than L1, the point is its nearest.
double l1_bank_rad(const L1& tuning, const Motion& motion, const Line& line);

/// The same on a circle. From afar the point is where a tangent touches it.
double l1_bank_rad(const L1& tuning, const Motion& motion, const Circle& circle);

/// A simpler follower: the bank that is proportional to the angle between the motion and a point
/// on the line, `ahead_m` beyond the foot of the perpendicular.
double carrot_bank_rad(double ahead_m, const Motion& motion, const Line& line);

/// The same on a circle, with the bank that a turn of its radius takes.
double carrot_bank_rad(double ahead_m, const Motion& motion, const Circle& circle);

/// How far along a line an aircraft is: 0 at its beginning, its length at its end. `right_m` is the
/// distance from it, positive to its right.
struct Along {
  double along_m = 0;
  double right_m = 0;
  double length_m = 0;
  double course_rad = 0;
};
Along along(const Line& line, const Motion& motion);

/// The climb that leads onto the line's height and along it. `time_s`: in which a deviation is to
/// decay.
double climb_rad(const Line& line, const Motion& motion, double height_m, double speed_m_s,
                 double time_s = 4);

/// How far before its end a leg is left so that a turn of that radius ends on the next one; no more
/// than half of either leg.
double turn_lead_m(double radius_m, const Line& leg, const Line& next);

}  // namespace reconnaissance
