#pragma once

#include <string>
#include <vector>

#include "harness/comparison.hpp"
#include "harness/machine.hpp"

namespace skein::benchmarks {

/// What the report needs besides the comparisons.
struct RunFacts {
  MachineFacts machine;
  /// What a reader must know before he trusts a figure; empty lines are left out.
  std::vector<std::string> remarks;
};

/// Writes a self-contained page: the goals, where Skein loses and wins, plots, all figures, the
/// machine. Claims whose comparisons have the parameter `size_bytes` are drawn by size, others as
/// single times. Throws Error where the file cannot be written.
void write_report(const std::vector<Comparison>& comparisons, const RunFacts& run,
                  const std::string& path);

}  // namespace skein::benchmarks
