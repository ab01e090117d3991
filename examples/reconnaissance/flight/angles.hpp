#pragma once

#include <cmath>
#include <numbers>

namespace reconnaissance {

/// The same angle from -pi to less than pi.
inline double wrapped(double angle_rad) {
  constexpr double kTurn = 2 * std::numbers::pi;
  return angle_rad - kTurn * std::floor((angle_rad + std::numbers::pi) / kTurn);
}

/// The same angle from 0 to less than 2 pi, as courses are.
inline double course(double angle_rad) {
  constexpr double kTurn = 2 * std::numbers::pi;
  const double positive = angle_rad - kTurn * std::floor(angle_rad / kTurn);
  return positive < kTurn ? positive : 0;
}

inline constexpr double radians(double degrees) { return degrees * std::numbers::pi / 180; }
inline constexpr double degrees(double radians) { return radians * 180 / std::numbers::pi; }

}  // namespace reconnaissance
