#pragma once

#include <cstddef>
#include <vector>

#include "harness/comparison.hpp"

namespace skein::benchmarks {

struct SelectionPlan {
  std::size_t scenarios;  ///< At most so many.
};

/// How good decisions are on problems that others recorded: the scenarios of ASlib in
/// `SKEIN_TEST_DATA/aslib`, replayed in virtual time by folds and online, with each strategy. The
/// rival is the single best algorithm; beside it stands, for `learned` by folds, a random forest
/// for each algorithm where selection/random_forest.csv has its gap closed.
std::vector<Comparison> compare_selection(const SelectionPlan& plan);

}  // namespace skein::benchmarks
