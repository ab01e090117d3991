#pragma once

#include <memory>
#include <vector>

#include "navigation/grid/scenario.hpp"

namespace skein::benchmarks {

struct MadeMap {
  const char* name;
  const char* planner;  ///< The one that suits it.
  std::shared_ptr<const navigation::grid::GridMap> map;
};

/// Planes of 512 x 512 cells, the same on every machine: caves (noise, smoothed until it hangs
/// together), and single cells that are blocked at random, a third of all.
std::vector<MadeMap> made_maps();

/// Tasks between random cells that are connected.
std::vector<navigation::grid::Scenario> made_scenarios(
    const std::shared_ptr<const navigation::grid::GridMap>& map, std::size_t count);

}  // namespace skein::benchmarks
