#include "navigation/planners/dubins.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "skein/error.hpp"

namespace skein::navigation {
namespace {

using AE_navigator::GroundPoint;
using Turn = DubinsPath::Turn;

constexpr double kCircle = 2 * std::numbers::pi;

double sign(Turn turn) { return static_cast<double>(turn); }

/// The turn by which one heading becomes another, from 0 to a full circle; what rounding has made
/// nearly a circle is none.
double turn_angle(double from, double to, Turn turn) {
  double angle = std::fmod(sign(turn) * (to - from), kCircle);
  if (angle < 0) angle += kCircle;
  return angle > kCircle - 1e-9 ? 0 : angle;
}

GroundPoint beside(const Pose& pose, Turn turn, double radius_m) {
  return {pose.point.north_m - sign(turn) * radius_m * std::sin(pose.heading_rad),
          pose.point.east_m + sign(turn) * radius_m * std::cos(pose.heading_rad)};
}

Pose after(const Pose& pose, const DubinsPath::Piece& piece, double radius_m) {
  if (piece.turn == Turn::Straight) {
    return {{pose.point.north_m + piece.length_m * std::cos(pose.heading_rad),
             pose.point.east_m + piece.length_m * std::sin(pose.heading_rad)},
            pose.heading_rad};
  }
  const GroundPoint middle = beside(pose, piece.turn, radius_m);
  const double heading = pose.heading_rad + sign(piece.turn) * piece.length_m / radius_m;
  return {{middle.north_m + sign(piece.turn) * radius_m * std::sin(heading),
           middle.east_m - sign(piece.turn) * radius_m * std::cos(heading)},
          heading};
}

struct Candidate {
  std::array<DubinsPath::Piece, 3> pieces;
  double length_m = std::numeric_limits<double>::infinity();
};

class ShortestWord {
 public:
  ShortestWord(const Pose& start, const Pose& goal, double radius_m)
      : start_(start), goal_(goal), radius_m_(radius_m) {}

  Candidate shortest() {
    for (const Turn first : {Turn::Left, Turn::Right}) {
      for (const Turn last : {Turn::Left, Turn::Right}) {
        look_from_circle_to_circle(first, last);
        if (first == last) look_at_three_arcs(first);
      }
    }
    return best_;
  }

 private:
  /// Along a tangent of both circles.
  void look_from_circle_to_circle(Turn first, Turn last) {
    const GroundPoint a = beside(start_, first, radius_m_);
    const GroundPoint b = beside(goal_, last, radius_m_);
    const double north = b.north_m - a.north_m;
    const double east = b.east_m - a.east_m;
    const double apart = std::hypot(north, east);
    double heading = apart > 0 ? std::atan2(east, north) : start_.heading_rad;
    double straight = apart;
    if (first != last) {
      if (apart < 2 * radius_m_) return;
      straight = std::sqrt(apart * apart - 4 * radius_m_ * radius_m_);
      heading += sign(first) * std::atan2(2 * radius_m_, straight);
    }
    offer(first, turn_angle(start_.heading_rad, heading, first), Turn::Straight, straight, last,
          turn_angle(heading, goal_.heading_rad, last));
  }

  /// By way of a third circle that touches those of both ends; it lies on either side of them.
  void look_at_three_arcs(Turn outer) {
    const GroundPoint a = beside(start_, outer, radius_m_);
    const GroundPoint b = beside(goal_, outer, radius_m_);
    const double north = b.north_m - a.north_m;
    const double east = b.east_m - a.east_m;
    const double apart = std::hypot(north, east);
    if (apart > 4 * radius_m_ || apart == 0) return;
    const Turn inner = outer == Turn::Left ? Turn::Right : Turn::Left;
    const double along = std::atan2(east, north);
    const double aside = std::acos(apart / (4 * radius_m_));
    for (const double side : {-1.0, 1.0}) {
      // Where an arc touches the next, the heading is at right angles to the line of their middles.
      const double to_third = along + side * aside;
      const double from_third = along - side * aside + std::numbers::pi;
      const double first_heading = to_third + sign(outer) * std::numbers::pi / 2;
      const double second_heading = from_third + sign(outer) * std::numbers::pi / 2;
      offer(outer, turn_angle(start_.heading_rad, first_heading, outer), inner,
            radius_m_ * turn_angle(first_heading, second_heading, inner), outer,
            turn_angle(second_heading, goal_.heading_rad, outer));
    }
  }

  void offer(Turn first, double first_angle, Turn middle, double middle_m, Turn last,
             double last_angle) {
    const double length = radius_m_ * (first_angle + last_angle) + middle_m;
    if (length >= best_.length_m) return;
    best_ = {
        {{{first, radius_m_ * first_angle}, {middle, middle_m}, {last, radius_m_ * last_angle}}},
        length};
  }

  const Pose& start_;
  const Pose& goal_;
  double radius_m_;
  Candidate best_{};
};

void require_flyable(const Pose& start, const Pose& goal, double radius_m) {
  for (const Pose& pose : {start, goal}) {
    if (std::isfinite(pose.point.north_m) && std::isfinite(pose.point.east_m) &&
        std::isfinite(pose.heading_rad)) {
      continue;
    }
    throw InvalidArgument("a Dubins path begins or ends at a pose that is not finite");
  }
  if (!(radius_m > 0 && std::isfinite(radius_m))) {
    throw InvalidArgument("a Dubins path needs a turn radius that is greater than 0 and finite");
  }
}

}  // namespace

DubinsPath::DubinsPath(const Pose& start, const Pose& goal, double radius_m)
    : start_(start), goal_(goal), radius_m_(radius_m) {
  require_flyable(start, goal, radius_m);
  pieces_ = ShortestWord(start, goal, radius_m).shortest().pieces;
}

double DubinsPath::length_m() const noexcept {
  return pieces_[0].length_m + pieces_[1].length_m + pieces_[2].length_m;
}

std::vector<GroundPoint> DubinsPath::waypoints() const {
  constexpr double kSharpest = 8 * std::numbers::pi / 180;
  std::vector<GroundPoint> points{start_.point};
  Pose pose = start_;
  for (const Piece& piece : pieces_) {
    if (piece.turn != Turn::Straight && piece.length_m > 0) {
      const double angle = piece.length_m / radius_m_;
      const int corners = static_cast<int>(std::ceil(angle / kSharpest));
      const double side = radius_m_ * std::tan(angle / corners / 2);
      for (int i = 0; i < corners; ++i) {
        const double share = static_cast<double>(i) / corners;
        const Pose touch = after(pose, {piece.turn, share * piece.length_m}, radius_m_);
        points.push_back(after(touch, {Turn::Straight, side}, radius_m_).point);
      }
    }
    pose = after(pose, piece, radius_m_);
  }
  points.push_back(goal_.point);
  return points;
}

}  // namespace skein::navigation
