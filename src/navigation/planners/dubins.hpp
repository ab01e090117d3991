#pragma once

#include <array>
#include <optional>
#include <vector>

#include "navigator.idl.hpp"

namespace skein::navigation {

/// A place on the map and the direction of flight there: radians from north, growing towards east.
struct Pose {
  AE_navigator::GroundPoint point;
  double heading_rad = 0;
};

/// The shortest way from pose to pose for an aircraft that flies forwards only and turns no tighter
/// than a radius: an arc, then a straight or an arc, then an arc (Dubins 1957).
///
/// Lengths are exact to rounding for all finite poses and positive radii: no tolerance decides
/// whether there is a path. A pure value; for any thread.
class DubinsPath {
 public:
  enum class Turn { Left = -1, Straight = 0, Right = 1 };
  struct Piece {
    Turn turn;
    double length_m;
  };

  /// Throws InvalidArgument for a number that is not finite or a radius that is not positive.
  DubinsPath(const Pose& start, const Pose& goal, double radius_m);

  double radius_m() const noexcept { return radius_m_; }
  double length_m() const noexcept;
  const std::array<Piece, 3>& pieces() const noexcept { return pieces_; }

  /// Where the aircraft is after so many metres; the ends beyond them.
  Pose at(double distance_m) const noexcept;

  /// Start, goal and the corners between: legs that are straight or touch the arcs, with no corner
  /// sharper than 8 degrees. As a route's waypoints they can be flown at the radius.
  std::vector<AE_navigator::GroundPoint> waypoints() const;

 private:
  Pose start_;
  Pose goal_;
  double radius_m_;
  std::array<Piece, 3> pieces_;
};

/// The same with altitude, for an aircraft that climbs and sinks no more steeply than an angle
/// (after Chitsaz and LaValle 2007, and Owen, Beard and McLain 2014): where the Dubins path is too
/// short for the climb, it is flown with a wider radius or after full circles at its lower end.
///
/// As short as any such path where the Dubins path is long enough or misses at least a full circle;
/// else at most one circle longer.
class DubinsAirplanePath {
 public:
  struct End {
    Pose pose;
    double altitude_m = 0;
  };

  /// Throws InvalidArgument as DubinsPath does, and for a climb angle that is not between 0 and 90
  /// degrees.
  DubinsAirplanePath(const End& start, const End& goal, double radius_m, double climb_angle_deg);

  /// Over ground.
  double ground_length_m() const noexcept { return circles_m() + path_.length_m(); }
  double length_m() const noexcept;
  int circles() const noexcept { return circles_; }
  double circle_radius_m() const noexcept { return circle_radius_m_; }
  const DubinsPath& path() const noexcept { return path_; }

  /// After so many metres over ground.
  End at(double ground_distance_m) const noexcept;

 private:
  double circles_m() const noexcept;

  End start_;
  End goal_;
  DubinsPath path_;
  int circles_ = 0;
  double circle_radius_m_;
};

}  // namespace skein::navigation
