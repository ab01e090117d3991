#pragma once

#include <vector>

namespace reconnaissance {

/// A place on the map and the course there.
struct RoutePose {
  double north_m = 0;
  double east_m = 0;
  double course_rad = 0;
};

/// The length of the shortest way from pose to pose for an aircraft that flies forwards only and
/// turns no tighter than the radius, which is positive (Dubins 1957): the least of the six words
/// LSL, RSR, LSR, RSL, LRL and RLR in closed form (Shkel and Lumelsky, "Classification of the
/// Dubins set", 2001).
double dubins_length_m(const RoutePose& from, const RoutePose& to, double radius_m);

/// The corners of that way, without its ends: its turns are the arcs of the radius that touch the
/// straight lines from corner to corner, an arc of more than 60 degrees those of several corners.
/// The course of each is the one after its turn.
std::vector<RoutePose> dubins_corners(const RoutePose& from, const RoutePose& to, double radius_m);

}  // namespace reconnaissance
