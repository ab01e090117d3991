#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "navigation/grid/grid_planner.hpp"
#include "navigation/grid/scenario.hpp"

namespace skein::benchmarks {

/// A planner on grids, and the results of its tasks so far.
struct GridContestant {
  std::string name;
  std::unique_ptr<navigation::grid::GridPlanner> planner;
  double preparation_ms = 0;
  std::vector<double> times_us{};
  std::vector<std::optional<double>> lengths{};  ///< Empty if it found no path.

  double mean_us() const;
};

/// Makes a planner for the map and takes the time. Throws what make_grid_planner() throws.
GridContestant prepare(const std::string& name,
                       const std::shared_ptr<const navigation::grid::GridMap>& map);

/// For each task all contestants, in a new random order.
void plan_in_turns(std::vector<GridContestant>& contestants,
                   const std::vector<navigation::grid::Scenario>& scenarios);

}  // namespace skein::benchmarks
