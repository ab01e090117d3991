#pragma once

#include <span>
#include <vector>

#include "navigator.idl.hpp"
#include "planning_grid.hpp"
#include "skein/navigation/terrain.hpp"

namespace skein::navigation {

/// The exposure rate at a given altitude over every node of a grid: fast enough for a search, which
/// asks a million times, where RadarExposure is exact. Terrain masking is computed once per site,
/// ring by ring outwards, each node taking the horizon of the ring before it.
class RiskMap {
 public:
  RiskMap(const Terrain& terrain, std::span<const AE_navigator::RadarSite> sites,
          const PlanningGrid& grid, const std::vector<float>& altitudes_m);

  double rate(int node) const { return rates_[static_cast<std::size_t>(node)]; }
  double rate(const GroundPoint& point) const { return grid_.interpolate(rates_, point); }

  /// The rate's integral along the straight line by Simpson's rule, on pieces of about one node.
  double along(const GroundPoint& a, const GroundPoint& b) const;

 private:
  void add_site(const AE_navigator::RadarSite& site, double antenna_altitude_m,
                const std::vector<float>& ground_m, const std::vector<float>& altitudes_m);

  PlanningGrid grid_;
  std::vector<float> rates_;
};

}  // namespace skein::navigation
