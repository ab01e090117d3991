#pragma once

#include <deque>

#include "geodesy/attitude.hpp"

namespace reconnaissance {

/// What of a radar decides how strong echoes are.
struct Transmitter {
  double peak_power_w;
  double antenna_gain;  ///< A ratio, as all of these: not decibels.
  double wavelength_m;
  double bandwidth_hz;
  double noise_figure = 1;
  double losses = 1;
};

/// The radar's constant C = P G² λ² / ((4π)³ T B F L) in J m²/K, for a receiver at T = 290 K.
double radar_constant(const Transmitter& transmitter);

/// The ratio of an echo's power to the noise, C σ / (k_B R⁴) (radar equation; the form is that of
/// Costley and others, "Sensitivity of the probability of radar detection to radar state
/// uncertainty", 2022). The range is positive.
double signal_to_noise(double radar_constant_j_m2_k, double cross_section_m2, double range_m);

/// The probability that one look detects a target that does not fluctuate, by North's approximation
/// ½ erfc(√(−ln P_fa) − √(SNR + ½)) (North, "An analysis of the factors which determine
/// signal/noise discrimination in pulsed-carrier systems", 1943; reprinted Proc. IEEE 51, 1963).
/// From the exact value, Marcum's Q, it differs by less than 0.007 where P_fa is 1e-3 to 1e-10. The
/// signal-to-noise ratio is a ratio of powers of 0 or more, P_fa between 0 and 1.
double detection_probability(double signal_to_noise, double false_alarm_probability);

/// The radar cross-section of a metal ellipsoid that is large against the wavelength,
/// σ = π a² b² c² / (a² x² + b² y² + c² z²)² for the unit vector (x, y, z) to the radar (Knott,
/// Shaeffer and Tuley, "Radar Cross Section", 1993; it is π times the product of the radii of
/// curvature). The half axes are along the fuselage, the wings and upward.
struct Ellipsoid {
  double forward_m;
  double right_m;
  double down_m;

  /// As a radar sees it from the direction of the vector (of any length but 0) in the body's axes.
  double cross_section_m2(const Eigen::Vector3d& to_radar_in_body) const;
};

/// The cross-section that an aircraft shows to a radar.
double aspect_cross_section_m2(const Ellipsoid& shape, const Local& aircraft,
                               const Attitude& attitude, const Local& radar);

/// Confirms a track as soon as m of the last n looks have detected.
class TrackConfirmation {
 public:
  /// 1 <= m <= n.
  TrackConfirmation(int m, int n) : m_(m), n_(n) {}

  /// Whether this look confirms.
  bool look(bool detected);

  void forget() { looks_.clear(); }

 private:
  int m_;
  int n_;
  std::deque<bool> looks_;
};

}  // namespace reconnaissance
