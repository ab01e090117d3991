#pragma once

#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "command/bench/statistics.hpp"
#include "harness/absence.hpp"

namespace skein::benchmarks {

/// What one contender showed: samples, or why there are none.
struct Outcome {
  std::vector<double> samples{};
  Absence absence{};
  std::size_t rounds = 0;  ///< In which it took its turn; 0 where that is not counted.
};

/// A subject beside its rival, both measured in the same run with the same parameters; or a subject
/// that was not measured, and why. One object of results.json.
struct Comparison {
  std::string claim;    ///< Equal for all comparisons that speak about one claim.
  std::string subject;  ///< `skein fastdds-cyclonedds` (provider first).
  std::string rival;    ///< `raw fastdds`; `limit 20 ms` where the rival is a promise.
  nlohmann::json parameters = nlohmann::json::object();
  std::vector<double> samples{};        ///< In `unit`, as measured.
  std::vector<double> rival_samples{};  ///< A promise is one sample.
  std::size_t rounds =
      0;  ///< Where the samples come turn after turn, a turn of both in each; else 0.
  /// The text of its goal, and the greatest ratios that meet it; empty if it has none.
  std::string goal{};
  std::optional<double> goal_p50{};
  std::optional<double> goal_p99{};
  /// Why there are no samples, where there are none.
  Absence absence{};
  std::string unit = "us";  ///< `us`, `octets` or `packets`.

  Summary summary() const { return summarize(samples); }
  Summary rival_summary() const { return summarize(rival_samples); }
  /// Of a measured one: the subject's figure by the rival's, round by round where there are rounds.
  double ratio_p50() const { return ratio_of_quantiles(samples, rival_samples, rounds, 0.5); }
  double ratio_p99() const { return ratio_of_quantiles(samples, rival_samples, rounds, 0.99); }
};

/// Gives `comparison` what both showed; nothing but the reason where one of them showed nothing.
void fill(Comparison& comparison, const Outcome& own, const Outcome& rival);

void append(std::vector<Comparison>& all, std::vector<Comparison> more);

/// Figures with their unit: `p50_us`, `p90_us`, `p95_us`, `p99_us`, `p999_us` (or `p50_octets`,
/// ...), the same with `rival_` before it, of all samples together, and the quotients `ratio_p50`
/// and `ratio_p99` (see ratio_of_quantiles), below 1 where the subject is faster or thriftier.
/// `unit` says which. All of them null where nothing was measured; `skipped` or `failed` then says
/// why. Few samples stand there themselves, too (`values`, `rival_values`), since a plot shows
/// them.
nlohmann::json to_json(const Comparison& comparison);

}  // namespace skein::benchmarks
