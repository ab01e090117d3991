#include "selection/scenario.hpp"

#include <algorithm>
#include <cmath>
#include <set>

#include "selection/arff.hpp"
#include "selection/description.hpp"
#include "selection/words.hpp"
#include "skein/error.hpp"

namespace skein::benchmarks::selection {
namespace {

struct Mean {
  double sum = 0;
  std::size_t count = 0;
  void add(double value) {
    sum += value;
    ++count;
  }
  double value() const { return sum / static_cast<double>(count); }
};

[[noreturn]] void refuse(const Arff& table, const ArffRow& row, const std::string& what) {
  throw InvalidArgument(table.file.string() + ":" + std::to_string(row.line) + ": " + what);
}

/// The runs of an algorithm on an instance: one per repetition.
struct Repetitions {
  std::set<double> seen;
  Mean time_s;
  bool solved = true;
  bool late = false;
};

class ScenarioReader {
 public:
  explicit ScenarioReader(const std::filesystem::path& folder)
      : folder_(folder), description_(read_description(folder / "description.txt")) {
    scenario_.id = description_.id;
    scenario_.cutoff_s = description_.cutoff_s;
  }

  Scenario read() {
    for (const std::string& step : description_.algorithm_steps)
      note("the features of algorithms are left out: step '" + step + "'");
    read_runs();
    read_folds();
    read_features();
    if (exists(folder_ / "feature_costs.arff")) read_costs();
    if (exists(folder_ / "feature_runstatus.arff")) read_presolved();
    return std::move(scenario_);
  }

 private:
  void read_runs() {
    const Arff table = read_arff(folder_ / "algorithm_runs.arff");
    const std::size_t instance = table.column("instance_id"), algorithm = table.column("algorithm");
    std::map<std::string, std::map<std::string, Repetitions>> runs;
    std::set<std::string> ran;
    for (const ArffRow& row : table.rows) {
      const std::string &name = table.text(row, instance), &by = table.text(row, algorithm);
      if (!runs.contains(name)) scenario_.instances.push_back({name, 0, {}});
      add_run(table, row, runs[name][by]);
      ran.insert(by);
    }
    choose_algorithms(ran);
    for (Instance& each : scenario_.instances) {
      for (const std::string& name : scenario_.algorithms)
        each.runs.push_back(summary(runs[each.name], name));
    }
  }

  void add_run(const Arff& table, const ArffRow& row, Repetitions& run) const {
    const double repetition = table.number(row, table.column("repetition")).value_or(1);
    if (!run.seen.insert(repetition).second)
      refuse(table, row, "this repetition of the run is there already; remove one of them");
    const double cutoff_s = scenario_.cutoff_s;
    const std::string status = lower(table.text(row, table.column("runstatus")));
    const auto recorded = table.number(row, runtime_column(table));
    if (recorded && *recorded < 0)
      refuse(table, row, "the runtime is negative; write seconds, or ? if it is missing");
    const double time_s = std::min(recorded.value_or(cutoff_s), cutoff_s);
    const bool late = status == "timeout" || time_s >= cutoff_s;
    run.time_s.add(late ? cutoff_s : time_s);
    run.late = run.late || late;
    run.solved = run.solved && status == "ok" && !late;
  }

  /// Some scenarios name the measure otherwise; it follows the algorithm.
  std::size_t runtime_column(const Arff& table) const {
    if (const auto named = table.find(description_.runtime)) return *named;
    const std::size_t next = table.column("algorithm") + 1;
    const bool is_number = next < table.attributes.size() &&
                           table.attributes[next].type == ArffAttribute::Type::Number;
    return is_number ? next : table.column(description_.runtime);
  }

  static AlgorithmRun summary(const std::map<std::string, Repetitions>& runs,
                              const std::string& algorithm) {
    const auto found = runs.find(algorithm);
    if (found == runs.end()) return {};
    const Repetitions& run = found->second;
    return {true, run.solved, run.late, run.time_s.value()};
  }

  /// Those that are listed and ran.
  void choose_algorithms(const std::set<std::string>& ran) {
    const auto& listed = description_.algorithms;
    for (const std::string& name : ran) {
      if (listed.empty() || std::ranges::binary_search(listed, name))
        scenario_.algorithms.push_back(name);
      else
        note("algorithm '" + name + "' is left out: description.txt does not list it");
    }
    for (const std::string& name : listed) {
      if (!ran.contains(name)) note("algorithm '" + name + "' is left out: it has no run");
    }
    if (scenario_.algorithms.empty()) {
      throw InvalidArgument((folder_ / "algorithm_runs.arff").string() +
                            " has no run of an algorithm that description.txt lists; correct one");
    }
  }

  void read_folds() {
    const Arff table = read_arff(folder_ / "cv.arff");
    const auto folds = first_folds(table);
    std::set<std::string> ran;
    for (const Instance& each : scenario_.instances) ran.insert(each.name);
    for (const auto& [name, fold] : folds) {
      if (!ran.contains(name)) note("instance '" + name + "' is left out: it has no run");
    }
    std::erase_if(scenario_.instances, [&](Instance& each) {
      const auto fold = folds.find(each.name);
      if (fold == folds.end())
        note("instance '" + each.name + "' is left out: cv.arff gives it no fold");
      else
        each.fold = fold->second;
      return fold == folds.end();
    });
    if (scenario_.instances.empty()) {
      throw InvalidArgument(table.file.string() +
                            " has no instance of algorithm_runs.arff; give each one a fold");
    }
  }

  /// Of the first repetition.
  static std::map<std::string, int> first_folds(const Arff& table) {
    const std::size_t instance = table.column("instance_id"), fold = table.column("fold");
    const std::size_t repetition = table.column("repetition");
    double first = INFINITY;
    for (const ArffRow& row : table.rows)
      first = std::min(first, table.number(row, repetition).value_or(1));
    std::map<std::string, int> folds;
    for (const ArffRow& row : table.rows) {
      if (table.number(row, repetition).value_or(1) != first) continue;
      const auto number = table.number(row, fold);
      if (!number) refuse(table, row, "the fold is missing; write its number");
      if (!folds.try_emplace(table.text(row, instance), static_cast<int>(*number)).second)
        refuse(table, row, "the instance has a fold already; remove one of the rows");
    }
    return folds;
  }

  void read_features() {
    const Arff table = read_arff(folder_ / "feature_values.arff");
    std::vector<std::size_t> columns;
    for (std::size_t i = 0; i < table.attributes.size(); ++i) {
      if (is_used_feature(table.attributes[i].name)) columns.push_back(i);
    }
    const auto values = means(table, columns);
    for (Instance& each : scenario_.instances) {
      const auto found = values.find(each.name);
      if (found == values.end()) continue;
      for (const auto& [column, mean] : found->second)
        each.features.emplace_back(table.attributes[column].name, mean.value());
    }
  }

  bool is_used_feature(const std::string& name) const {
    if (description_.steps.empty())
      return lower(name) != "instance_id" && lower(name) != "repetition";
    return std::ranges::any_of(description_.used_steps(), [&](const std::string& step) {
      const auto& provided = description_.steps.at(step).provides;
      return std::ranges::find(provided, name) != provided.end();
    });
  }

  /// The columns of the steps that are used.
  std::vector<std::size_t> step_columns(const Arff& table) const {
    std::vector<std::size_t> columns;
    for (std::size_t i = 0; i < table.attributes.size(); ++i) {
      const auto steps = description_.used_steps();
      const std::string name = lower(table.attributes[i].name);
      const bool is_key = name == "instance_id" || name == "repetition";
      const bool is_used =
          std::ranges::any_of(steps, [&](const std::string& step) { return lower(step) == name; });
      if (!is_key && (steps.empty() || is_used)) columns.push_back(i);
    }
    return columns;
  }

  /// By instance and column, over the repetitions.
  static std::map<std::string, std::map<std::size_t, Mean>> means(
      const Arff& table, const std::vector<std::size_t>& columns) {
    const std::size_t instance = table.column("instance_id");
    std::map<std::string, std::map<std::size_t, Mean>> found;
    for (const ArffRow& row : table.rows) {
      for (const std::size_t column : columns) {
        if (const auto value = table.number(row, column))
          found[table.text(row, instance)][column].add(*value);
      }
    }
    return found;
  }

  void read_costs() {
    const Arff table = read_arff(folder_ / "feature_costs.arff");
    const auto costs = means(table, step_columns(table));
    for (Instance& each : scenario_.instances) {
      const auto found = costs.find(each.name);
      if (found == costs.end()) continue;
      for (const auto& [column, mean] : found->second)
        each.features_cost_s += std::max(0.0, mean.value());
    }
  }

  void read_presolved() {
    const Arff table = read_arff(folder_ / "feature_runstatus.arff");
    const std::size_t instance = table.column("instance_id");
    const auto columns = step_columns(table);
    std::set<std::string> presolved;
    for (const ArffRow& row : table.rows) {
      for (const std::size_t column : columns) {
        if (lower(row.cells[column].value_or("")) == "presolved")
          presolved.insert(table.text(row, instance));
      }
    }
    for (Instance& each : scenario_.instances) each.presolved = presolved.contains(each.name);
  }

  void note(const std::string& text) { scenario_.notes.push_back(text); }

  std::filesystem::path folder_;
  Description description_;
  Scenario scenario_;
};

}  // namespace

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
  return ScenarioReader(folder).read();
}

}  // namespace skein::benchmarks::selection
