#include "selection/scenario.hpp"

#include <algorithm>
#include <cstdio>
#include <nlohmann/json.hpp>

#include "data_files.hpp"
#include "skein/error.hpp"

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
  FILE* const pipe = popen((command + '\'').c_str(), "r");
  if (pipe == nullptr) throw Internal("no process can be made to read " + folder.string());
  std::string output;
  char buffer[4096];
  for (std::size_t count; (count = fread(buffer, 1, sizeof buffer, pipe)) > 0;)
    output.append(buffer, count);
  const bool was_read = pclose(pipe) == 0;
  if (was_read) return nlohmann::json::parse(output).get<Scenario>();
  output.resize(output.find_last_not_of('\n') + 1);
  throw InvalidArgument(output.empty() ? folder.string() + " cannot be read; see above" : output);
}

}  // namespace skein::benchmarks::selection
