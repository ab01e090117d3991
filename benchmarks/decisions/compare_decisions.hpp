#pragma once

#include <filesystem>
#include <vector>

#include "harness/comparison.hpp"

namespace skein::benchmarks {

struct DecisionPlan {
  std::size_t every;  ///< Only each n-th of the frozen instances.
};

/// How good the Head's decisions are: the frozen instances (instances.csv) in their order, each
/// answered by every algorithm alone and by the Head with each strategy, one contestant after the
/// other in a new random order for each request. So what all algorithms would have made of a
/// request stands beside what was chosen, measured within the same second. `learned` begins with no
/// history, learns in the training part, and is scored in the held-out part. Writes decisions.csv,
/// a row a request, into the folder.
std::vector<Comparison> compare_decisions(const DecisionPlan& plan,
                                          const std::filesystem::path& folder);

}  // namespace skein::benchmarks
