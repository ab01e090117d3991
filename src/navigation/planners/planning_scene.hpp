#pragma once

#include <array>
#include <memory>
#include <optional>
#include <vector>

#include "navigation/planners/flight_surface.hpp"
#include "navigation/planners/planning_budget.hpp"
#include "navigation/planners/search.hpp"
#include "navigation/terrain/terrain_provider.hpp"
#include "navigation/threats/keep_out.hpp"
#include "navigation/threats/risk_map.hpp"
#include "navigator.idl.hpp"

namespace skein::navigation {

/// The terrain of a Problem. Throws InvalidProblem where it is not to be had, or the Problem breaks
/// a rule.
std::shared_ptr<const Terrain> load_valid(TerrainProvider& terrains,
                                          const AE_navigator::Problem& problem);

/// One Problem, checked and made ready for a search. Lives for one call of `plan`.
class PlanningScene {
 public:
  /// Throws InvalidProblem, also for a terrain that is not to be had.
  explicit PlanningScene(const Search& search);

  const AE_navigator::Problem& problem() const { return problem_; }
  const Terrain& terrain() const { return *terrain_; }
  const PlanningBudget& budget() const { return budget_; }
  const PlanningGrid& grid() const { return surface_.grid(); }
  const FlightSurface& surface() const { return surface_; }
  const std::vector<KeepOut>& keep_outs(Berth berth) const {
    return keep_outs_[berth == Berth::ForTurns];
  }

  /// Whether threats cost anything.
  bool fears_threats() const;

  /// What threats cost in metres of detour per metre flown. Made at first use; a planner that does
  /// not care about threats never pays for it.
  const RiskMap& risk() const;

  /// The zone that a leg along the flight surface would enter, or nullptr.
  const KeepOut* zone_across(const GroundPoint& a, const GroundPoint& b, Berth berth) const;

  bool free(const GroundPoint& point, Berth berth) const {
    return surface_.open(point, berth) && !zone_across(point, point, berth);
  }

  /// Whether the straight leg stays on open surface and clear of the zones.
  bool free(const GroundPoint& a, const GroundPoint& b, Berth berth) const;

  /// Length of a leg along the flight surface plus what threats cost on it.
  double cost(const GroundPoint& a, const GroundPoint& b) const;

 private:
  std::shared_ptr<const Terrain> terrain_;
  const AE_navigator::Problem& problem_;
  PlanningBudget budget_;
  FlightSurface surface_;
  std::array<std::vector<KeepOut>, 2> keep_outs_;
  mutable std::optional<RiskMap> risk_;
};

}  // namespace skein::navigation
