#pragma once

#include <cmath>

#include "threats/radar.hpp"

namespace reconnaissance {

/// Kills per second that a site threatens an aircraft with: the zone's rate while it guides and the
/// aircraft is in its zone, otherwise 0.
inline double hazard_per_s(const RadarSite& site, RadarMode mode, const Local& aircraft) {
  const bool threatened = mode == RadarMode::Guidance && site.zone.contains(site.antenna, aircraft);
  return threatened ? site.zone.kills_per_s : 0;
}

/// The probability of having survived so far, exp(−∫ λ dt) (Kim and Hespanha, "Discrete
/// approximations to continuous shortest-path: application to minimum-risk path planning for groups
/// of UAVs", 2003).
class Survival {
 public:
  /// A time under a hazard, which is the sum of those of all sites.
  void pass(double hazard_per_s, double seconds) { expected_kills_ += hazard_per_s * seconds; }

  double probability() const { return std::exp(-expected_kills_); }

 private:
  double expected_kills_ = 0;
};

}  // namespace reconnaissance
