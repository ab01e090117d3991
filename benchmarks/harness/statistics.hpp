#pragma once

#include <cstddef>
#include <vector>

namespace skein::benchmarks {

/// What is reported of a set of measured times; microseconds.
struct Summary {
  std::size_t samples = 0;
  double p50 = 0;
  double p90 = 0;
  double p95 = 0;
  double p99 = 0;
  double p999 = 0;
  double least = 0;
  double greatest = 0;
};

/// The smallest sample that at least the share `q` (0 to 1) of all samples does not exceed (nearest
/// rank: a time that was really measured). `sorted` ascends and is not empty.
double quantile(const std::vector<double>& sorted, double q);

/// All zero for no samples.
Summary summarize(std::vector<double> samples);

}  // namespace skein::benchmarks
