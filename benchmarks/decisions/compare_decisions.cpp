#include "decisions/compare_decisions.hpp"

#include <functional>

#include "command/bench/random_turns.hpp"
#include "data_files.hpp"
#include "decisions/decision_table.hpp"
#include "decisions/scores.hpp"
#include "harness/goals.hpp"
#include "navigation/route_checker/route_checker.hpp"
#include "skein/selection.hpp"

namespace skein::benchmarks {
namespace {

/// The independent judge: shares no code with planners and Body. Turns are not judged: this
/// aircraft turns on the spot.
bool is_valid(const Request& request, const AE_navigator::Route& route) {
  const navigation::Terrain& terrain = *request.world->terrain;
  const navigation::HeightGrid ground{terrain.rows(), terrain.columns(), terrain.north_spacing_m(),
                                      terrain.east_spacing_m(), terrain.heights_m()};
  const double cap = request.problem.exposure_cap_m;
  return navigation::check_route(request.problem, route, ground).empty() &&
         (cap == 0 || route.radar_exposure <= cap);
}

class Contest {
 public:
  explicit Contest(const DecisionPlan& plan)
      : requests_(read_requests(kDecisionInstances, algorithm_names(), plan.every)) {
    const auto algorithms = make_algorithms(requests_.terrains, stage_);
    for (const Algorithm& algorithm : algorithms)
      contestants_.push_back(std::make_unique<Contestant>(algorithm, requests_.terrains));
    for (const std::string& strategy : StrategyFactory().names()) {
      contestants_.push_back(
          std::make_unique<Contestant>(strategy, algorithms, requests_.terrains));
    }
  }

  std::vector<Trial> run() {
    constexpr std::uint32_t kSeed = 1;
    std::vector<Trial> trials(requests_.all.size());
    std::size_t now = 0;
    std::vector<std::function<void()>> turns;
    for (const auto& contestant : contestants_)
      turns.emplace_back([&] { take_turn(*contestant, requests_.all[now], trials[now]); });
    take_turns(trials.size(), turns, kSeed, "decisions",
               [&](std::size_t round) { now = round + 1; });
    return trials;
  }

  std::size_t without_data() const { return requests_.without_data; }

 private:
  void take_turn(Contestant& contestant, const Request& request, Trial& trial) {
    stage_.set(request.factors, request.hangs);
    Answer answer = contestant.answer(request);
    stage_.clear();
    contestant.settle();
    if (answer.route) trial.valid[contestant.name()] = is_valid(request, *answer.route);
    trial.request = &request;
    trial.answers[contestant.name()] = std::move(answer);
  }

  Requests requests_;
  Stage stage_;
  std::vector<std::unique_ptr<Contestant>> contestants_;
};

nlohmann::json parameters_of(const Scores& scores, std::size_t without_data) {
  return {{"single_best", scores.single_best},
          {"single_best_par10_ms", scores.single_best_ms},
          {"virtual_best_par10_ms", scores.virtual_best_ms},
          {"par10_ms", scores.contestant_ms},
          {"gap_closed", scores.gap_closed()},
          {"requests", scores.requests},
          {"solvable", scores.solvable},
          {"missed", scores.missed},
          {"accepted", scores.accepted},
          {"invalid_accepted", scores.invalid},
          {"requests_left_out_without_test_data", without_data}};
}

/// What is lost to the virtual best, beside what the single best loses; in microseconds, and more
/// than nothing.
Comparison loss_of(const std::string& subject, const Scores& scores, const char* part,
                   std::size_t without_data) {
  const auto loss = [&](double score_ms) {
    return std::max(1.0, 1000 * (score_ms - scores.virtual_best_ms));
  };
  Comparison comparison{"PAR10 beyond the virtual best, mean over requests", subject, "single best",
                        parameters_of(scores, without_data)};
  comparison.parameters["where"] = part;
  comparison.samples = {loss(scores.contestant_ms)};
  comparison.rival_samples = {loss(scores.single_best_ms)};
  return comparison;
}

Comparison validity_of(const std::string& subject, const Scores& scores) {
  Comparison comparison{
      "results that the Head accepts", subject, "those that are valid", {{"where", "held-out"}}};
  comparison.unit = "results";
  comparison.samples = {static_cast<double>(scores.accepted)};
  comparison.rival_samples = {static_cast<double>(scores.accepted - scores.invalid)};
  return comparison;
}

Comparison lateness_of(const std::string& subject, const std::vector<Trial>& trials) {
  Comparison comparison{"deadline to the answer, an algorithm hangs",
                        subject,
                        "limit 5 ms",
                        {{"where", "all algorithms hang, or one"}}};
  for (const Trial& trial : trials) {
    if (trial.request->hangs.empty()) continue;
    const double limit_ms = std::chrono::duration<double, std::milli>(trial.request->limit).count();
    const double late_ms = trial.answers.at(subject).time_ms - limit_ms;
    comparison.samples.push_back(std::max(1.0, 1000 * late_ms));
  }
  if (comparison.samples.empty()) comparison.absence.reason = "no algorithm hung in so short a run";
  comparison.rival_samples = {kLateAnswerUs};
  return comparison;
}

}  // namespace

std::vector<Comparison> compare_decisions(const DecisionPlan& plan,
                                          const std::filesystem::path& folder) {
  Contest contest(plan);
  const std::vector<Trial> trials = contest.run();
  write_decision_table(trials, folder / "decisions.csv");
  std::vector<Comparison> comparisons;
  for (const std::string& strategy : StrategyFactory().names()) {
    const Scores scores = scores_of(strategy, trials, "held_out");
    comparisons.push_back(loss_of(strategy, scores, "held-out", contest.without_data()));
    comparisons.push_back(loss_of(strategy, scores_of(strategy, trials, "training"), "training",
                                  contest.without_data()));
    comparisons.push_back(validity_of(strategy, scores));
    comparisons.push_back(lateness_of(strategy, trials));
  }
  for (Comparison& comparison : comparisons) comparison.subject = "skein " + comparison.subject;
  return comparisons;
}

}  // namespace skein::benchmarks
