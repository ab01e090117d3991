#include "harness/statistics.hpp"

#include <algorithm>
#include <cmath>

namespace skein::benchmarks {

double quantile(const std::vector<double>& sorted, double q) {
  const double rank = std::ceil(q * static_cast<double>(sorted.size()));
  const auto last = static_cast<double>(sorted.size());
  return sorted[static_cast<std::size_t>(std::clamp(rank, 1.0, last)) - 1];
}

Summary summarize(std::vector<double> samples) {
  if (samples.empty()) return {};
  std::sort(samples.begin(), samples.end());
  const auto at = [&](double q) { return quantile(samples, q); };
  return {samples.size(), at(0.5),   at(0.9),         at(0.95),
          at(0.99),       at(0.999), samples.front(), samples.back()};
}

}  // namespace skein::benchmarks
