#pragma once

#include <array>
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

  double length_m() const noexcept;

  /// Start, goal and the corners between: legs that are straight or touch the arcs, with no corner
  /// sharper than 8 degrees. As a route's waypoints they can be flown at the radius.
  std::vector<AE_navigator::GroundPoint> waypoints() const;

 private:
  Pose start_;
  Pose goal_;
  double radius_m_;
  std::array<Piece, 3> pieces_;
};

}  // namespace skein::navigation
