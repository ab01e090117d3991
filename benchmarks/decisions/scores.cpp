#include "decisions/scores.hpp"

#include <algorithm>

namespace skein::benchmarks {
namespace {

constexpr double kPenalty = 10;

double limit_ms(const Request& request) {
  return std::chrono::duration<double, std::milli>(request.limit).count();
}

}  // namespace

bool Trial::solved_by(const std::string& contestant) const {
  const Answer& answer = answers.at(contestant);
  return answer.route && valid.at(contestant) && answer.time_ms <= limit_ms(*request);
}

double Trial::par10(const std::string& contestant) const {
  return solved_by(contestant) ? answers.at(contestant).time_ms : kPenalty * limit_ms(*request);
}

const std::string& Trial::virtual_best() const {
  return *std::ranges::min_element(algorithm_names(), {},
                                   [&](const auto& name) { return par10(name); });
}

std::string single_best_of(const std::vector<Trial>& trials) {
  return *std::ranges::min_element(algorithm_names(), {}, [&](const std::string& name) {
    double sum = 0;
    for (const Trial& trial : trials) {
      if (trial.request->part == "training") sum += trial.par10(name);
    }
    return sum;
  });
}

Scores scores_of(const std::string& contestant, const std::vector<Trial>& trials,
                 const std::string& part) {
  Scores scores;
  scores.single_best = single_best_of(trials);
  for (const Trial& trial : trials) {
    if (trial.request->part != part) continue;
    ++scores.requests;
    scores.virtual_best_ms += trial.par10(trial.virtual_best());
    scores.single_best_ms += trial.par10(scores.single_best);
    scores.contestant_ms += trial.par10(contestant);
    scores.solvable += trial.solved_by(trial.virtual_best()) ? 1 : 0;
    scores.missed += trial.solved_by(contestant) ? 0 : 1;
    const bool accepted = trial.answers.at(contestant).route.has_value();
    scores.accepted += accepted ? 1 : 0;
    scores.invalid += accepted && !trial.valid.at(contestant) ? 1 : 0;
  }
  for (double* sum : {&scores.virtual_best_ms, &scores.single_best_ms, &scores.contestant_ms})
    *sum /= static_cast<double>(std::max<std::size_t>(1, scores.requests));
  return scores;
}

}  // namespace skein::benchmarks
