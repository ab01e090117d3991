#pragma once

#include <Eigen/Geometry>

#include "geodesy/local_frame.hpp"

namespace reconnaissance {

/// How an aircraft is turned against the local frame, in the usual order: heading clockwise from
/// north, then pitch (nose up is positive), then roll (right wing down is positive).
struct Attitude {
  double roll_rad = 0;
  double pitch_rad = 0;
  double heading_rad = 0;
};

/// Turns vectors of the body (forward, right, down) into vectors of the local frame (north, east,
/// down).
inline Eigen::Matrix3d body_to_ned(const Attitude& attitude) {
  using Eigen::AngleAxisd, Eigen::Vector3d;
  return (AngleAxisd(attitude.heading_rad, Vector3d::UnitZ()) *
          AngleAxisd(attitude.pitch_rad, Vector3d::UnitY()) *
          AngleAxisd(attitude.roll_rad, Vector3d::UnitX()))
      .toRotationMatrix();
}

/// The way from one place to another: north, east, down in metres.
inline Eigen::Vector3d ned_between(const Local& from, const Local& to) {
  return {to.north_m - from.north_m, to.east_m - from.east_m, from.height_m - to.height_m};
}

inline double slant_range_m(const Local& a, const Local& b) { return ned_between(a, b).norm(); }

}  // namespace reconnaissance
