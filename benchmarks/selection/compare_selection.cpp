#include "selection/compare_selection.hpp"

#include <algorithm>
#include <cstdlib>
#include <fstream>
#include <map>
#include <sstream>

#include "data_files.hpp"
#include "selection/replay.hpp"
#include "skein/clock.hpp"
#include "skein/selection.hpp"

namespace skein::benchmarks {
namespace {

using selection::Scenario;
using selection::SelectionScores;

constexpr const char* kClaim = "recorded problems: PAR10 beyond the virtual best";
constexpr const char* kMeanClaim = "recorded problems: share of the gap left open";
constexpr const char* kFolds = "learned from the other folds";
constexpr const char* kOnline = "online, from nothing";

std::vector<std::filesystem::path> recorded_scenarios(std::size_t at_most) {
  const char* data = std::getenv("SKEIN_TEST_DATA");
  const auto folder = std::filesystem::path(data ? data : "") / "aslib";
  std::vector<std::filesystem::path> scenarios;
  if (data && std::filesystem::is_directory(folder)) {
    for (const auto& entry : std::filesystem::directory_iterator(folder))
      if (entry.is_directory()) scenarios.push_back(entry.path());
  }
  std::ranges::sort(scenarios);
  scenarios.resize(std::min(at_most, scenarios.size()));
  return scenarios;
}

std::map<std::string, double> gaps_of_forests() {
  std::map<std::string, double> gaps;
  std::ifstream file(kRandomForestGaps);
  for (std::string line; std::getline(file, line);) {
    const std::size_t comma = line.find(',');
    if (line.starts_with('#') || comma == std::string::npos) continue;
    gaps[line.substr(0, comma)] = std::stod(line.substr(comma + 1));
  }
  return gaps;
}

/// In microseconds, and more than nothing.
double loss_us(double par10_s, const SelectionScores& scores) {
  return std::max(1.0, 1e6 * (par10_s - scores.virtual_best));
}

Comparison beside_single_best(const std::string& scenario, const std::string& strategy,
                              const std::string& mode, const SelectionScores& scores) {
  Comparison comparison{kClaim,
                        "skein " + strategy,
                        "single best",
                        {{"where", scenario + ", " + mode},
                         {"scenario", scenario},
                         {"mode", mode},
                         {"gap_closed", scores.gap_closed()},
                         {"par10_s", scores.par10},
                         {"virtual_best_par10_s", scores.virtual_best},
                         {"single_best_par10_s", scores.single_best},
                         {"attempts", scores.attempts},
                         {"decide_us", scores.decide_us}}};
  comparison.samples = {loss_us(scores.par10, scores)};
  comparison.rival_samples = {loss_us(scores.single_best, scores)};
  return comparison;
}

Comparison beside_forest(const Comparison& learned, const SelectionScores& scores, double gap) {
  Comparison comparison = learned;
  const double par10_s = scores.single_best - gap * (scores.single_best - scores.virtual_best);
  comparison.rival = "random forests";
  comparison.parameters["rival_gap_closed"] = gap;
  comparison.rival_samples = {loss_us(par10_s, scores)};
  return comparison;
}

/// In thousandths of the gap, so that scenarios of hours and of minutes count alike.
Comparison mean_of(const std::string& strategy, const std::string& mode,
                   const std::vector<double>& gaps) {
  double open = 0;
  for (const double gap : gaps) open += 1000 * (1 - gap) / static_cast<double>(gaps.size());
  Comparison comparison{kMeanClaim,
                        "skein " + strategy,
                        "single best",
                        {{"where", "mean of the scenarios, " + mode},
                         {"mode", mode},
                         {"scenarios", gaps.size()},
                         {"gap_closed", 1 - open / 1000}}};
  comparison.unit = "thousandths";
  comparison.samples = {std::max(1.0, open)};
  comparison.rival_samples = {1000};
  return comparison;
}

}  // namespace

std::vector<Comparison> compare_selection(const SelectionPlan& plan) {
  const auto folders = recorded_scenarios(plan.scenarios);
  if (folders.empty()) {
    Comparison missing{kClaim, "skein learned", "single best", {{"where", "scenarios of ASlib"}}};
    missing.absence.reason = "SKEIN_TEST_DATA names no folder with scenarios of ASlib";
    return {missing};
  }
  const SystemClock clock;
  const auto forests = gaps_of_forests();
  std::vector<Comparison> comparisons;
  std::map<std::pair<std::string, std::string>, std::vector<double>> gaps;  // by mode, strategy
  for (const auto& folder : folders) {
    const Scenario scenario = selection::read_scenario(folder);
    for (const std::string& strategy : StrategyFactory().names()) {
      for (const std::string mode : {kFolds, kOnline}) {
        const auto answers = mode == kFolds ? selection::replay_folds(scenario, strategy, clock)
                                            : selection::replay_online(scenario, strategy, clock);
        const SelectionScores scores = selection::scores_of(scenario, answers);
        gaps[{mode, strategy}].push_back(scores.gap_closed());
        comparisons.push_back(beside_single_best(scenario.id, strategy, mode, scores));
        const auto forest = forests.find(scenario.id);
        if (strategy == "learned" && mode == kFolds && forest != forests.end())
          comparisons.push_back(beside_forest(comparisons.back(), scores, forest->second));
      }
    }
  }
  for (const auto& [which, each] : gaps) {
    const auto& [mode, strategy] = which;
    comparisons.push_back(mean_of(strategy, mode, each));
  }
  return comparisons;
}

}  // namespace skein::benchmarks
