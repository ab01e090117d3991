#pragma once

#include <span>
#include <vector>

#include "navigation/threats/terrain_mask.hpp"
#include "navigator.idl.hpp"

namespace skein::navigation {

/// The probability that a radar detects a steady target in one look, by North's approximation: half
/// of erfc(sqrt(-ln P_fa) - sqrt(SNR + 1/2)). `signal_to_noise` is a ratio of powers (not
/// decibels), 0 or more; `false_alarm_probability` is between 0 and 1. Throws InvalidArgument for
/// others.
double detection_probability(double signal_to_noise, double false_alarm_probability);

/// The signal-to-noise ratio at `distance_m` of a radar that has the ratio `at_reference` at
/// `reference_m`: it falls with the fourth power of the distance.
double signal_to_noise(double at_reference, double reference_m, double distance_m);

/// The probability that at least one of several independent looks detects: 1 - product(1 - P_k).
double cumulative_detection(std::span<const double> probabilities);

/// The chance to survive missile sites. The hazard at a point is the sum of the rates of the sites
/// that have it within range and in sight (over an earth of 4/3 its radius, terrain hides); the
/// probability of surviving a flight is exp(-integral of the hazard over time).
///
/// Const members may be called from any thread. The terrain must outlive it.
class MissileThreat {
 public:
  MissileThreat(const Terrain& terrain, std::span<const AE_navigator::MissileSite> sites);

  /// Kills per second.
  double hazard(const AE_navigator::Position& point) const;

  /// The hazard's integral over the flight along straight edges at a constant speed. The part of an
  /// edge within range is found exactly, sight along it by three looks at each 40 m (at 1/6, 1/2
  /// and 5/6). Throws InvalidArgument for a speed that is not positive.
  double expected_kills(std::span<const AE_navigator::Position> waypoints, double speed_m_s) const;

  /// exp(-expected_kills).
  double survival(std::span<const AE_navigator::Position> waypoints, double speed_m_s) const;

 private:
  struct Launcher {
    AE_navigator::Position position;
    double range_m;
    double kills_per_second;
  };
  bool sees(const Launcher& launcher, const AE_navigator::Position& point) const;
  double seconds_in_danger(const Launcher& launcher, const AE_navigator::Position& a,
                           const AE_navigator::Position& b, double speed_m_s) const;

  TerrainMask mask_;
  std::vector<Launcher> launchers_;
};

}  // namespace skein::navigation
