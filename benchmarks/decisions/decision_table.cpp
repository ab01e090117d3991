#include "decisions/decision_table.hpp"

#include <fmt/format.h>

#include <fstream>
#include <limits>

#include "skein/error.hpp"
#include "skein/head.hpp"

namespace skein::benchmarks {
namespace {

std::string outcome_of(const Trial& trial, const std::string& contestant) {
  const Answer& answer = trial.answers.at(contestant);
  if (!answer.route) return answer.outcome;
  if (!trial.valid.at(contestant)) return "invalid";
  return trial.solved_by(contestant) ? "valid" : "late";
}

std::string quality_of(const Trial& trial) {
  if (!trial.solved_by("learned")) return "";
  double shortest_m = std::numeric_limits<double>::infinity();
  for (const auto& [name, answer] : trial.answers) {
    if (answer.route && trial.valid.at(name))
      shortest_m = std::min(shortest_m, answer.route->length_m);
  }
  return fmt::format("{:.3f}", shortest_m / trial.answers.at("learned").route->length_m);
}

std::string head_of(const Trial& trial) {
  std::string head = "part,request,world";
  for (const Feature& feature :
       features_of(trial.request->problem, *trial.request->world->terrain)) {
    head += "," + feature.name;
  }
  head +=
      ",limit_ms,hangs,chosen,attempts,time_ms,outcome,quality,virtual_best,virtual_best_ms,"
      "single_best,single_best_ms";
  for (const auto& [name, answer] : trial.answers) head += "," + name + "_ms," + name;
  return head + "\n";
}

std::string trial_row(const Trial& trial, const std::string& single_best) {
  const Request& request = *trial.request;
  const Answer& answer = trial.answers.at("learned");
  std::string row =
      fmt::format("{},{},{}", request.part, request.number, request.world->terrain->name());
  for (const Feature& feature : features_of(request.problem, *request.world->terrain))
    row += fmt::format(",{:.6g}", feature.value);
  const std::string& best = trial.virtual_best();
  row += fmt::format(",{:.3f},{},{},{},{:.3f},{},{},{},{:.3f},{},{:.3f}",
                     std::chrono::duration<double, std::milli>(request.limit).count(),
                     request.hangs, answer.chosen, answer.attempts, answer.time_ms,
                     outcome_of(trial, "learned"), quality_of(trial), best, trial.par10(best),
                     single_best, trial.par10(single_best));
  for (const auto& [name, each] : trial.answers)
    row += fmt::format(",{:.3f},{}", each.time_ms, outcome_of(trial, name));
  return row + "\n";
}

}  // namespace

void write_decision_table(const std::vector<Trial>& trials, const std::filesystem::path& file) {
  const std::string single_best = single_best_of(trials);
  std::ofstream table(file);
  if (!trials.empty()) table << head_of(trials.front());
  for (const Trial& trial : trials) table << trial_row(trial, single_best);
  if (!table.flush())
    throw Internal(file.string() + " cannot be written; is its folder there and writable?");
}

}  // namespace skein::benchmarks
