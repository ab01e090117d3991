#pragma once

#include <optional>

#include "geodesy/local_frame.hpp"

namespace reconnaissance {

/// Where an aircraft is and how it moves over ground.
struct TrafficState {
  Local place;
  double north_m_s = 0;
  double east_m_s = 0;
  double up_m_s = 0;

  double course_rad() const;
  double ground_speed_m_s() const;
};

/// The state after a time of straight flight at constant speed and climb rate.
TrafficState straight_on(const TrafficState& state, double seconds);

/// At the same speed over ground.
TrafficState on_course(TrafficState state, double course_rad);

/// What two aircraft shall keep free of each other: horizontally a distance and a time (modified
/// tau), vertically a height. Both must be violated at once.
struct WellClearVolume {
  double distance_m = 0;
  double height_m = 0;
  double tau_s = 0;
};

constexpr double kNauticalMile_m = 1852;
constexpr double kFoot_m = 0.3048;

/// RTCA DO-365B, as in NASA DAIDALUS's DO_365B_no_SUM.conf: en route (DTHR, ZTHR, TTHR), its
/// preventive volume, and near mid-air collision.
constexpr WellClearVolume kEnRoute{0.66 * kNauticalMile_m, 450 * kFoot_m, 35};
constexpr WellClearVolume kPreventive{0.66 * kNauticalMile_m, 700 * kFoot_m, 35};
constexpr WellClearVolume kNearMidAirCollision{500 * kFoot_m, 100 * kFoot_m, 0};

/// Is the volume violated now? WCV_TAUMOD after Muñoz, Narkawicz, Chamberlain, Consiglio and
/// Upchurch, "A Family of Well-Clear Boundary Models for the Integration of UAS in the NAS" (AIAA
/// 2014-2412): height difference ≤ ZTHR, and either distance ≤ DTHR, or the closest distance on the
/// present courses ≤ DTHR and 0 ≤ τ ≤ TTHR with τ = (DTHR² − s²) / s·v while they converge.
/// Symmetric in the two aircraft.
bool violates(const TrafficState& own, const TrafficState& other, const WellClearVolume& volume);

struct Period {
  double in_s = 0;
  double out_s = 0;
};

/// First and last time, from now to the look-ahead, at which the volume is violated if both fly
/// straight on; nothing if it never is. Closed form: what is violated horizontally is one period,
/// from a root of |v|² t² + (2 s·v + TTHR |v|²) t + s² + TTHR s·v − DTHR² to the time at which the
/// distance grows beyond DTHR, and what is violated vertically is one, too.
std::optional<Period> violation(const TrafficState& own, const TrafficState& other,
                                const WellClearVolume& volume, double look_ahead_s);

/// The least max(horizontal / distance, vertical / height) of straight flight from now to the
/// look-ahead: 1 touches a cylinder of that size, 0 is a collision. In closed form.
double least_separation(const TrafficState& own, const TrafficState& other, double distance_m,
                        double height_m, double look_ahead_s);

}  // namespace reconnaissance
