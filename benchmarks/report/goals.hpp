#pragma once

#include <string>
#include <vector>

#include "harness/comparison.hpp"

namespace skein::benchmarks {

/// A table of all goals, as HTML: where each came off worst in this run, and whether it was met.
std::string goals_section(const std::vector<Comparison>& comparisons);

}  // namespace skein::benchmarks
