#include "command/bench/statistics.hpp"

#include <algorithm>
#include <cmath>
#include <span>

namespace skein::benchmarks {
namespace {

double quantile_of(std::span<const double> samples, double q) {
  std::vector<double> sorted(samples.begin(), samples.end());
  std::sort(sorted.begin(), sorted.end());
  return quantile(sorted, q);
}

}  // namespace

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

double ratio_of_quantiles(const std::vector<double>& subject, const std::vector<double>& rival,
                          std::size_t rounds, double q) {
  const std::size_t turn = rounds == 0 ? 0 : subject.size() / rounds;
  const bool in_turns = turn * rounds == subject.size() && rival.size() == subject.size();
  // A tolerance, as 1 - 0.99 is a little more than a hundredth.
  if (rounds < 2 || !in_turns || static_cast<double>(turn) * (1 - q) < 0.999) {
    return quantile_of(subject, q) / quantile_of(rival, q);
  }
  std::vector<double> ratios;
  for (std::size_t round = 0; round < rounds; ++round) {
    const auto own = std::span(subject).subspan(round * turn, turn);
    const auto other = std::span(rival).subspan(round * turn, turn);
    ratios.push_back(quantile_of(own, q) / quantile_of(other, q));
  }
  return quantile_of(ratios, 0.5);
}

}  // namespace skein::benchmarks
