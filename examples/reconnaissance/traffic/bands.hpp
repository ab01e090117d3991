#pragma once

#include <span>
#include <vector>

#include "traffic/well_clear.hpp"

namespace reconnaissance {

/// What the own aircraft can do, and how far guidance looks ahead. Defaults: DAIDALUS,
/// DO_365B_no_SUM.conf (steps, turn rate, vertical acceleration and rate, look-ahead).
struct ManoeuvreLimits {
  double turn_rate_rad_s = 0.0523598775598;  ///< 3 °/s.
  double vertical_acceleration_m_s2 = 0.25 * 9.80665;
  double least_climb_m_s = -6.2;  ///< 6° at 60 m/s.
  double greatest_climb_m_s = 6.2;
  double look_ahead_s = 180;
};

constexpr double kCourseStep_rad = 0.0174532925199;  // 1°
constexpr double kClimbStep_m_s = 100 * kFoot_m / 60;

/// One manoeuvre that was tried: a value, and what comes of it against all intruders flying
/// straight on.
struct Manoeuvre {
  double value = 0;    ///< Course in radians from −π to π, or climb rate in m/s.
  double change = 0;   ///< From the present value; courses: right is positive, −π to π.
  bool free = false;   ///< The volume is at no time violated up to the look-ahead.
  double clear_s = 0;  ///< From then on it is not; infinite if not within the look-ahead.
  /// The least separation, horizontal or vertical whichever is greater, as a multiple of near
  /// mid-air collision. Infinite where the volume is never violated.
  double nmac_multiple = 0;
  /// Likewise as a multiple of the volume's distance and height.
  double volume_multiple = 0;
};

/// Courses: at each, the aircraft turns towards it at the turn rate, the shorter way round, and
/// flies on at present speed and climb rate. All that are not free are the bands to keep out of. By
/// steps of a degree from the present course to either side; the turn is judged at each step, the
/// flight after it in closed form.
std::vector<Manoeuvre> course_bands(const TrafficState& own, std::span<const TrafficState> others,
                                    const WellClearVolume& volume, const ManoeuvreLimits& limits);

/// Climb rates, likewise: reached at the vertical acceleration. The present one, and multiples of
/// 100 ft/min within the limits.
std::vector<Manoeuvre> climb_bands(const TrafficState& own, std::span<const TrafficState> others,
                                   const WellClearVolume& volume, const ManoeuvreLimits& limits);

}  // namespace reconnaissance
