#pragma once

#include <vector>

#include "harness/comparison.hpp"

namespace skein::benchmarks {

struct GridPlan {
  std::size_t made_scenarios;  ///< On each map that is made here.
  std::size_t every;           ///< Only each n-th recorded scenario.
};

/// The planners on grids beside plain A*: each scenario, and the mean over all scenarios of a map.
/// The maps are made here, or those in the folder that SKEIN_TEST_DATA names, without which they
/// show as skipped. What needs preparation is prepared beforehand; `parameters` say for how long.
/// Throws std::runtime_error where a path is not as short as the rival's.
std::vector<Comparison> compare_grids(const GridPlan& plan);

}  // namespace skein::benchmarks
