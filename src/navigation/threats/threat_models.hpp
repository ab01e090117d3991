#pragma once

#include <span>
#include <vector>

#include "navigation/threats/terrain_mask.hpp"
#include "navigator.idl.hpp"

namespace skein::navigation {

/// What missile sites cost. The hazard at a point is the sum of the rates of the sites that have it
/// within range and in sight (over an earth of 4/3 its radius, terrain hides); the probability of
/// surviving a flight is exp(-integral of the hazard over time).
///
/// Const members may be called from any thread. The terrain must outlive it.
class MissileThreat {
 public:
  MissileThreat(const Terrain& terrain, std::span<const AE_navigator::MissileSite> sites);

  /// The hazard's integral over the flight along straight edges at a constant speed. The part of an
  /// edge within range is found exactly, sight along it by three looks at each 40 m (at 1/6, 1/2
  /// and 5/6). Throws InvalidArgument for a speed that is not positive.
  double expected_kills(std::span<const AE_navigator::Position> waypoints, double speed_m_s) const;

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
