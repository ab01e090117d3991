#pragma once

#include <cstddef>
#include <vector>

namespace skein::benchmarks {

/// The figures of a set of measured times; microseconds.
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

/// The subject's quantile by the rival's, if both took a turn in each of so many rounds: the
/// median over the rounds, so that a disturbance of one turn counts once, and one of a
/// round hits both. If a turn has too few samples for that quantile (a p99 needs 100), or there
/// are no rounds, all are taken together. Samples lie turn after turn; neither is empty.
double ratio_of_quantiles(const std::vector<double>& subject, const std::vector<double>& rival,
                          std::size_t rounds, double q);

}  // namespace skein::benchmarks
