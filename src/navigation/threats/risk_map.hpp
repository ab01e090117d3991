#pragma once

#include <span>
#include <vector>

#include "navigation/terrain/planning_grid.hpp"
#include "navigation/terrain/terrain.hpp"
#include "navigator.idl.hpp"

namespace skein::navigation {

/// What threats cost per metre flown at a given altitude over every node of a grid: fast enough for
/// a search, which asks a million times, where RadarExposure and MissileThreat are exact. Terrain
/// masking is computed once per site, ring by ring outwards, each node taking the horizon of the
/// ring before it.
class RiskMap {
 public:
  /// Without a threat. Terrain and altitudes must outlive it.
  RiskMap(const Terrain& terrain, const PlanningGrid& grid, const std::vector<float>& altitudes_m);

  /// Adds the sites' exposure rates, `weight` times.
  void add(std::span<const AE_navigator::RadarSite> sites, double weight);
  /// Adds the sites' kills per second, `weight` times.
  void add(std::span<const AE_navigator::MissileSite> sites, double weight);

  double rate(int node) const { return rates_[static_cast<std::size_t>(node)]; }
  double rate(const GroundPoint& point) const { return grid_.interpolate(rates_, point); }

  /// The rate's integral along the straight line by Simpson's rule, on pieces of about one node.
  double along(const GroundPoint& a, const GroundPoint& b) const;

 private:
  template <class Rate>
  void add_site(const GroundPoint& site, double mast_height_m, const Rate& rate_at);

  const Terrain& terrain_;
  const std::vector<float>& altitudes_m_;
  PlanningGrid grid_;
  std::vector<float> ground_m_;
  std::vector<float> rates_;
};

}  // namespace skein::navigation
