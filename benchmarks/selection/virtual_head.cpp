#include "selection/virtual_head.hpp"

#include <algorithm>

#include "selection/service_history.hpp"
#include "skein/entity.hpp"

namespace skein::benchmarks::selection {
namespace {

constexpr auto kInterface = "aslib";

using Seconds = std::chrono::duration<double>;

Duration duration(double seconds) { return std::chrono::duration_cast<Duration>(Seconds(seconds)); }
double seconds(Duration duration) { return Seconds(duration).count(); }

std::shared_ptr<const Features> features_of(const Instance& instance) {
  Features features;
  for (const auto& [name, value] : instance.features) features.push_back({name, value});
  return std::make_shared<const Features>(std::move(features));
}

}  // namespace

VirtualHead::VirtualHead(const Scenario& scenario, const std::string& strategy, const Clock& clock)
    : scenario_(scenario), strategy_(StrategyFactory().make(strategy)), clock_(clock) {}

void VirtualHead::teach(const Instance& instance) {
  const auto features = features_of(instance);
  const std::uint64_t number = history_.begin(kInterface);
  for (std::size_t i = 0; i < instance.runs.size(); ++i) {
    const AlgorithmRun& run = instance.runs[i];
    if (!run.known) continue;
    history_.add(kInterface, scenario_.algorithms[i],
                 {features, duration(run.time_s), run.solved, run.late, {}, number});
  }
}

void VirtualHead::learn() { history_.learn(); }

std::vector<Candidate> VirtualHead::candidates(const Features& features) const {
  std::vector<Candidate> found(scenario_.algorithms.size());
  for (std::size_t i = 0; i < found.size(); ++i) found[i].name = scenario_.algorithms[i];
  if (!strategy_->reads_history()) return found;
  auto predictions = history_.predict(
      kInterface, {scenario_.algorithms.begin(), scenario_.algorithms.end()}, features);
  for (std::size_t i = 0; i < found.size(); ++i) found[i].learned = std::move(predictions[i]);
  return found;
}

VirtualHead::Ending VirtualHead::run(const AlgorithmRun& run, Duration slice) {
  const Duration end = duration(run.time_s);
  const bool solved = run.solved && end <= slice;
  const bool late = !solved && (run.solved || run.late || !run.known || end > slice);
  return {solved, late, late ? slice : end};
}

void VirtualHead::remember(const Candidate& candidate, const Ending& ending,
                           const std::shared_ptr<const Features>& features, std::uint32_t after) {
  history_.add(kInterface, candidate.name,
               {features,
                ending.took,
                ending.solved,
                ending.late,
                {},
                history_.decisions(kInterface).made,
                after},
               candidate.learned ? &*candidate.learned : nullptr);
}

Answer VirtualHead::decide(const Instance& instance, bool learns) {
  Answer answer;
  const bool reads = strategy_->reads_history();
  const auto features = reads ? features_of(instance) : std::make_shared<const Features>();
  const Duration cutoff = duration(scenario_.cutoff_s);
  Duration spent = reads ? duration(instance.features_cost_s) : Duration::zero();
  answer.solved = reads && instance.presolved && spent <= cutoff;
  const auto past = history_.decisions(kInterface);
  if (learns) history_.begin(kInterface);
  Instant begin = clock_.now();
  const double exploration = learns ? HeadOptions().exploration : 0;
  CandidateIterator iterator(*strategy_, candidates(*features),
                             {*features, {}, exploration, past, {}, {}});
  Duration deciding = clock_.now() - begin;
  while (!answer.solved && !iterator.done() && spent < cutoff) {
    begin = clock_.now();
    const auto [candidate, selection] = iterator.next(cutoff - spent);
    deciding += clock_.now() - begin;
    const auto algorithm = static_cast<std::size_t>(
        std::ranges::find(scenario_.algorithms, candidate.name) - scenario_.algorithms.begin());
    const Ending ending = run(instance.runs[algorithm], selection.slice);
    if (learns && instance.runs[algorithm].known)
      remember(candidate, ending, features, static_cast<std::uint32_t>(answer.attempts.size()));
    if (learns && selection.explores) history_.note_exploration(kInterface);
    answer.solved = ending.solved;
    answer.attempts.push_back({algorithm, seconds(selection.slice)});
    spent += ending.took;
  }
  if (const auto lesson = learns ? history_.next_lesson(kInterface) : nullptr) {
    lesson->learn();
    history_.take(*lesson);
  }
  answer.time_s = seconds(spent);
  answer.decide_us = std::chrono::duration<double, std::micro>(deciding).count();
  return answer;
}

}  // namespace skein::benchmarks::selection
