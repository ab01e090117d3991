#include "selection/scenario.hpp"

#include <algorithm>
#include <nlohmann/json.hpp>

#include "data_files.hpp"
#include "skein/error.hpp"
#include "test/tools/shell.hpp"

namespace skein::benchmarks::selection {

NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(AlgorithmRun, known, solved, late, time_s)
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(Instance, name, fold, runs, features, features_cost_s, presolved)
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(Scenario, id, cutoff_s, algorithms, instances, notes)

std::size_t Scenario::single_best() const {
  std::vector<double> sums(algorithms.size());
  for (const Instance& each : instances) {
    for (std::size_t i = 0; i < sums.size(); ++i) sums[i] += par10(each.runs[i]);
  }
  return static_cast<std::size_t>(std::ranges::min_element(sums) - sums.begin());
}

std::size_t Scenario::virtual_best(const Instance& instance) const {
  const auto best = std::ranges::min_element(
      instance.runs, {}, [this](const AlgorithmRun& run) { return par10(run); });
  return static_cast<std::size_t>(best - instance.runs.begin());
}

Scenario read_scenario(const std::filesystem::path& folder) {
  std::string command = "'" + std::string(kAslibReader) + "' '";
  for (const char letter : folder.string())
    command += letter == '\'' ? "'\\''" : std::string(1, letter);
  const auto [exit_code, output] = test::shell(command + '\'');
  if (exit_code == 0) return nlohmann::json::parse(output).get<Scenario>();
  throw InvalidArgument(output.substr(0, output.find_last_not_of('\n') + 1));
}

}  // namespace skein::benchmarks::selection
