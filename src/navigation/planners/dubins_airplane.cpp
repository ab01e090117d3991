#include <algorithm>
#include <cmath>
#include <numbers>

#include "navigation/planners/dubins.hpp"
#include "skein/error.hpp"

namespace skein::navigation {
namespace {

/// The Dubins path of a wider radius that is just as long as wanted. The length jumps where another
/// kind of path becomes the shortest, so there may be none.
std::optional<DubinsPath> stretched(const DubinsPath& path, const Pose& start, const Pose& goal,
                                    double wanted_m) {
  double narrow = path.radius_m();
  double wide = 2 * wanted_m;  // Wide enough, unless the goal lies nearly straight ahead.
  if (DubinsPath(start, goal, wide).length_m() < wanted_m) return std::nullopt;
  for (int i = 0; i < 100; ++i) {
    const double middle = (narrow + wide) / 2;
    (DubinsPath(start, goal, middle).length_m() < wanted_m ? narrow : wide) = middle;
  }
  DubinsPath found(start, goal, wide);
  if (found.length_m() > wanted_m * (1 + 1e-9)) return std::nullopt;
  return found;
}

double climb_slope(double climb_angle_deg) {
  if (climb_angle_deg > 0 && climb_angle_deg < 90) {
    return std::tan(climb_angle_deg * std::numbers::pi / 180);
  }
  throw InvalidArgument("a Dubins airplane climbs at an angle between 0 and 90 degrees");
}

}  // namespace

DubinsAirplanePath::DubinsAirplanePath(const End& start, const End& goal, double radius_m,
                                       double climb_angle_deg)
    : start_(start),
      goal_(goal),
      path_(start.pose, goal.pose, radius_m),
      circle_radius_m_(radius_m) {
  const double climb_m = std::abs(goal.altitude_m - start.altitude_m);
  if (!std::isfinite(climb_m)) {
    throw InvalidArgument("a Dubins airplane begins or ends at an altitude that is not finite");
  }
  const double missing_m = climb_m / climb_slope(climb_angle_deg) - path_.length_m();
  if (missing_m <= 0) return;
  const double circle_m = 2 * std::numbers::pi * radius_m;
  circles_ = static_cast<int>(missing_m / circle_m);
  if (circles_ > 0) {
    circle_radius_m_ = missing_m / (2 * std::numbers::pi * circles_);
  } else if (auto wider = stretched(path_, start.pose, goal.pose, path_.length_m() + missing_m)) {
    path_ = *wider;
  } else {
    circles_ = 1;
  }
}

double DubinsAirplanePath::circles_m() const noexcept {
  return 2 * std::numbers::pi * circle_radius_m_ * circles_;
}

double DubinsAirplanePath::length_m() const noexcept {
  return std::hypot(ground_length_m(), goal_.altitude_m - start_.altitude_m);
}

DubinsAirplanePath::End DubinsAirplanePath::at(double ground_distance_m) const noexcept {
  const double all_m = ground_length_m();
  if (all_m == 0) return start_;
  const double distance_m = std::clamp(ground_distance_m, 0.0, all_m);
  const double climbed = (goal_.altitude_m - start_.altitude_m) * distance_m / all_m;
  // Circles are flown at the lower end, where there is most air above.
  const bool at_start = start_.altitude_m <= goal_.altitude_m;
  const double into_circles = at_start ? distance_m : distance_m - path_.length_m();
  Pose pose;
  if (into_circles > 0 && into_circles < circles_m()) {
    const Pose& end = at_start ? start_.pose : goal_.pose;
    const double turned = into_circles / circle_radius_m_;
    const double heading = end.heading_rad + turned;
    pose = {{end.point.north_m + circle_radius_m_ * (std::sin(heading) - std::sin(end.heading_rad)),
             end.point.east_m - circle_radius_m_ * (std::cos(heading) - std::cos(end.heading_rad))},
            heading};
  } else {
    pose = path_.at(at_start ? distance_m - circles_m() : distance_m);
  }
  return {pose, start_.altitude_m + climbed};
}

}  // namespace skein::navigation
