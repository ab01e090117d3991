// Judges a selection strategy on an ASlib scenario, in virtual time.

#include <CLI/CLI.hpp>
#include <cstdio>

#include "selection/replay.hpp"
#include "skein/error.hpp"

using namespace skein::benchmarks::selection;

namespace {

struct Arguments {
  std::string scenario;
  std::string strategy = "learned";
  std::string csv;
  bool online = false;
};

void judge(const Arguments& arguments) {
  const Scenario scenario = read_scenario(arguments.scenario);
  for (const std::string& note : scenario.notes) std::fprintf(stderr, "%s\n", note.c_str());
  const skein::SystemClock clock;
  const auto answers = arguments.online ? replay_online(scenario, arguments.strategy, clock)
                                        : replay_folds(scenario, arguments.strategy, clock);
  if (!arguments.csv.empty()) write_answers(arguments.csv, scenario, answers);
  const SelectionScores scores = scores_of(scenario, answers);
  std::printf(
      "instances %zu par10 %.3f vbs %.3f sbs %.3f gap_closed %.4f attempts %.2f decide_us %.1f\n",
      answers.size(), scores.par10, scores.virtual_best, scores.single_best, scores.gap_closed(),
      scores.attempts, scores.decide_us);
}

}  // namespace

int main(int count, char** values) {
  CLI::App program("Judges Skein's algorithm selection on a scenario of ASlib.");
  Arguments arguments;
  program.add_option("SCENARIO", arguments.scenario, "folder of the scenario")->required();
  program.add_option("--strategy", arguments.strategy, "selection strategy")->capture_default_str();
  program.add_option("--csv", arguments.csv, "file for a row per instance");
  program.add_flag("--online", arguments.online, "learn from its own attempts only, in one pass");
  CLI11_PARSE(program, count, values);
  try {
    judge(arguments);
  } catch (const skein::Error& error) {
    std::fprintf(stderr, "skein-select: %s\n", error.what());
    return 1;
  }
}
