#include "selection/replay.hpp"

#include <algorithm>
#include <fstream>
#include <numeric>
#include <random>
#include <set>
#include <sstream>

#include "skein/error.hpp"

namespace skein::benchmarks::selection {
namespace {

constexpr unsigned kSeed = 1;

std::string quoted(const std::string& text) {
  if (text.find_first_of(",\"\n") == std::string::npos) return text;
  std::string found = "\"";
  for (const char letter : text) found += letter == '"' ? "\"\"" : std::string(1, letter);
  return found + '"';
}

std::string sequence(const Scenario& scenario, const Answer& answer) {
  std::ostringstream text;
  for (const auto& [algorithm, slice_s] : answer.attempts)
    text << (text.tellp() > 0 ? " " : "") << scenario.algorithms[algorithm] << ':' << slice_s;
  return text.str();
}

void write_row(std::ostream& csv, const Scenario& scenario, const Instance& instance,
               const Answer& answer) {
  csv << quoted(instance.name) << ',' << instance.fold << ',' << answer.solved << ','
      << answer.time_s << ',' << answer.attempts.size() << ',' << quoted(sequence(scenario, answer))
      << ',';
  const std::size_t best = scenario.virtual_best(instance);
  if (instance.runs[best].solved)
    csv << quoted(scenario.algorithms[best]) << ',' << instance.runs[best].time_s << '\n';
  else
    csv << ",\n";
}

double median(std::vector<double> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::ranges::nth_element(values, middle);
  return *middle;
}

}  // namespace

// Not std::shuffle, whose result differs between standard libraries.
std::vector<std::size_t> shuffled(std::size_t count) {
  std::vector<std::size_t> order(count);
  std::iota(order.begin(), order.end(), std::size_t(0));
  std::mt19937 random(kSeed);
  for (std::size_t i = count; i > 1; --i) std::swap(order[i - 1], order[random() % i]);
  return order;
}

std::vector<Answer> replay_folds(const Scenario& scenario, const std::string& strategy,
                                 const Clock& clock) {
  std::vector<Answer> answers(scenario.instances.size());
  std::set<int> folds;
  for (const Instance& each : scenario.instances) folds.insert(each.fold);
  // Neighbours in a file are alike, so that its order would look like drift.
  const auto order = shuffled(answers.size());
  for (const int fold : folds) {
    VirtualHead head(scenario, strategy, clock);
    for (const std::size_t i : order) {
      if (scenario.instances[i].fold != fold) head.teach(scenario.instances[i]);
    }
    head.learn();
    for (std::size_t i = 0; i < answers.size(); ++i) {
      if (scenario.instances[i].fold == fold)
        answers[i] = head.decide(scenario.instances[i], false);
    }
  }
  return answers;
}

std::vector<Answer> replay_online(const Scenario& scenario, const std::string& strategy,
                                  const Clock& clock) {
  std::vector<Answer> answers(scenario.instances.size());
  VirtualHead head(scenario, strategy, clock);
  for (const std::size_t i : shuffled(answers.size()))
    answers[i] = head.decide(scenario.instances[i], true);
  return answers;
}

double par10(const Scenario& scenario, const Answer& answer) {
  return answer.solved ? answer.time_s : 10 * scenario.cutoff_s;
}

SelectionScores scores_of(const Scenario& scenario, const std::vector<Answer>& answers) {
  SelectionScores scores;
  const std::size_t single_best = scenario.single_best();
  const auto count = static_cast<double>(answers.size());
  std::vector<double> decide_us;
  for (std::size_t i = 0; i < answers.size(); ++i) {
    const Instance& instance = scenario.instances[i];
    scores.par10 += par10(scenario, answers[i]) / count;
    scores.single_best += scenario.par10(instance.runs[single_best]) / count;
    scores.virtual_best += scenario.par10(instance.runs[scenario.virtual_best(instance)]) / count;
    scores.attempts += static_cast<double>(answers[i].attempts.size()) / count;
    decide_us.push_back(answers[i].decide_us);
  }
  scores.decide_us = median(std::move(decide_us));
  return scores;
}

void write_answers(const std::filesystem::path& csv, const Scenario& scenario,
                   const std::vector<Answer>& answers) {
  std::ofstream stream(csv);
  stream << "instance,fold,solved,time_s,attempts,sequence,best,best_time_s\n";
  for (std::size_t i = 0; i < answers.size(); ++i)
    write_row(stream, scenario, scenario.instances[i], answers[i]);
  if (!stream.flush())
    throw InvalidArgument(csv.string() + " cannot be written; name a file in a folder that may be");
}

}  // namespace skein::benchmarks::selection
