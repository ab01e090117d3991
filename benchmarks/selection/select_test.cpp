#include <catch2/catch.hpp>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <sstream>

#include "selection/replay.hpp"
#include "skein/error.hpp"
#include "test/tools/temporary_folder.hpp"

using namespace skein::benchmarks::selection;
using Catch::Contains;
namespace fs = std::filesystem;

namespace {

const std::string kDescription =
    "scenario_id: tiny\n"
    "performance_measures: runtime\n"
    "performance_type: [runtime]\n"
    "algorithm_cutoff_time: 100\n"
    "metainfo_algorithms:\n"
    "  a: {deterministic: true}\n"
    "  b: {deterministic: true}\n"
    "feature_steps:\n"
    "  base: {provides: [size]}\n"
    "  more: {provides: [depth], requires: [base]}\n"
    "  other: {provides: [width]}\n"
    "default_steps: [more]\n";

const std::string kRunsHeader =
    "@RELATION runs\n@ATTRIBUTE instance_id STRING\n@ATTRIBUTE repetition NUMERIC\n"
    "@ATTRIBUTE algorithm STRING\n@ATTRIBUTE runtime NUMERIC\n"
    "@ATTRIBUTE runstatus {ok, timeout, memout, not_applicable, crash, other}\n@DATA\n";

// fixed_order tries a for half of the time, and then b for what is left.
const std::string kRuns = kRunsHeader +
                          "i1,1,a,10,ok\ni1,1,b,20,ok\n"
                          "i2,1,a,100,timeout\ni2,1,b,30,ok\n"
                          "i3,1,a,5,crash\ni3,1,b,90,ok\n"
                          "i4,1,a,100,ok\ni4,1,b,?,memout\n";

std::string keyed(const std::string& attributes, const std::string& rows) {
  return "@relation r\n@attribute instance_id string\n@attribute repetition numeric\n" +
         attributes + "@data\n" + rows;
}

void write_tiny(const TemporaryFolder& folder) {
  folder.write("description.txt", kDescription);
  folder.write("algorithm_runs.arff", kRuns);
  folder.write("cv.arff",
               keyed("@attribute fold numeric\n", "i1,1,1\ni2,1,1\ni3,1,2\ni4,1,2\ni1,2,2\n"));
  folder.write("feature_values.arff", keyed("@attribute size numeric\n@attribute depth numeric\n"
                                            "@attribute width numeric\n",
                                            "i1,1,1,?,7\ni2,1,2,8,7\ni2,2,4,8,7\n"));
  folder.write("feature_costs.arff",
               keyed("@attribute base numeric\n@attribute more numeric\n@attribute other numeric\n",
                     "i1,1,1,2,50\ni2,1,1,?,50\n"));
  folder.write("feature_runstatus.arff",
               keyed("@attribute base {ok,presolved}\n@attribute more {ok,presolved}\n",
                     "i1,1,presolved,ok\ni2,1,ok,ok\n"));
}

void check_scenario_refused(const TemporaryFolder& folder, const std::string& place,
                            const std::string& cause) {
  CHECK_THROWS_WITH(read_scenario(folder.path()), Contains(place) && Contains(cause));
}

/// Of the test data; ends the program as skipped without it.
fs::path data() {
  const char* folder = std::getenv("SKEIN_TEST_DATA");
  if (folder && fs::is_directory(fs::path(folder) / "aslib")) return fs::path(folder) / "aslib";
  std::fputs("skipped: SKEIN_TEST_DATA names no folder with aslib\n", stderr);
  std::_Exit(77);
}

}  // namespace

TEST_CASE("A scenario has runs, folds, and the features of its default steps at their cost") {
  const TemporaryFolder folder;
  write_tiny(folder);
  const Scenario scenario = read_scenario(folder.path());
  CHECK(scenario.algorithms == std::vector<std::string>{"a", "b"});
  REQUIRE(scenario.instances.size() == 4);
  const auto& [first, second, third, fourth] = std::tie(
      scenario.instances[0], scenario.instances[1], scenario.instances[2], scenario.instances[3]);
  using Named = std::vector<std::pair<std::string, double>>;
  CHECK(first.features == Named{{"size", 1}});
  CHECK(second.features == Named{{"size", 3}, {"depth", 8}});
  CHECK(third.features.empty());
  CHECK(first.features_cost_s == 3);
  CHECK(second.features_cost_s == 1);
  CHECK(first.presolved);
  CHECK_FALSE(second.presolved);
  CHECK(third.fold == 2);
  CHECK_FALSE(third.runs[0].late);
  CHECK_FALSE(fourth.runs[0].solved);
  CHECK(fourth.runs[0].late);
  CHECK(fourth.runs[1].time_s == 100);
}

TEST_CASE("In the Broker's order the scores are those that one computes by hand") {
  const TemporaryFolder folder;
  write_tiny(folder);
  const Scenario scenario = read_scenario(folder.path());
  const skein::ManualClock clock;
  const auto answers = replay_folds(scenario, "fixed_order", clock);
  // i1: a in 10 s. i2: a for 50 s, b in 30 s. i3: a crashes after 5 s, b in 90 s. i4: unsolved.
  CHECK(answers[0].time_s == Approx(10));
  CHECK(answers[1].time_s == Approx(80));
  CHECK(answers[2].time_s == Approx(95));
  CHECK_FALSE(answers[3].solved);
  const SelectionScores scores = scores_of(scenario, answers);
  CHECK(scores.par10 == Approx((10 + 80 + 95 + 1000) / 4.0));
  CHECK(scores.virtual_best == Approx((10 + 30 + 90 + 1000) / 4.0));
  CHECK(scores.single_best == Approx((20 + 30 + 90 + 1000) / 4.0));
  CHECK(scores.gap_closed() == Approx((1140 - 1185) / 10.0));
  CHECK(scores.attempts == Approx(7 / 4.0));
}

TEST_CASE("What uses features pays for them, and is spared an instance that they solve") {
  const TemporaryFolder folder;
  write_tiny(folder);
  const Scenario scenario = read_scenario(folder.path());
  const skein::ManualClock clock;
  for (const auto& answers :
       {replay_folds(scenario, "learned", clock), replay_online(scenario, "learned", clock)}) {
    CHECK(answers[0].solved);
    CHECK(answers[0].time_s == Approx(3));
    CHECK(answers[0].attempts.empty());
    CHECK(answers[1].time_s >= 31);
  }
}

TEST_CASE("The table of answers has a row per instance") {
  const TemporaryFolder folder;
  write_tiny(folder);
  const Scenario scenario = read_scenario(folder.path());
  const skein::ManualClock clock;
  const fs::path csv = folder.path() / "answers.csv";
  write_answers(csv, scenario, replay_folds(scenario, "fixed_order", clock));
  std::stringstream text;
  text << std::ifstream(csv).rdbuf();
  CHECK(text.str() ==
        "instance,fold,solved,time_s,attempts,sequence,best,best_time_s\n"
        "i1,1,1,10,1,a:50,a,10\n"
        "i2,1,1,80,2,a:50 b:50,b,30\n"
        "i3,2,1,95,2,a:50 b:95,b,90\n"
        "i4,2,0,100,2,a:50 b:50,,\n");
}

TEST_CASE("Several repetitions of a run count by their mean, and as solved if all are") {
  const TemporaryFolder folder;
  write_tiny(folder);
  folder.write("algorithm_runs.arff",
               kRunsHeader + "i1,1,a,10,ok\ni1,2,a,30,ok\ni1,1,b,10,ok\ni1,2,b,100,timeout\n");
  const Scenario scenario = read_scenario(folder.path());
  REQUIRE(scenario.instances.size() == 1);
  CHECK(scenario.instances[0].runs[0].time_s == 20);
  CHECK(scenario.instances[0].runs[0].solved);
  CHECK_FALSE(scenario.instances[0].runs[1].solved);
  CHECK_THAT(scenario.notes.front(), Contains("instance 'i2' is left out: it has no run"));
}

TEST_CASE("A scenario may list its algorithms elsewhere, and have no steps, costs or run states") {
  const TemporaryFolder folder;
  write_tiny(folder);
  folder.write("description.txt",
               "performance_measures: [PAR10]\nperformance_type: runtime\n"
               "algorithm_cutoff_time: '100'\nalgorithms_deterministic: a, c\n"
               "algorithms_stochastic: '?'\n");
  fs::remove(folder.path() / "feature_costs.arff");
  fs::remove(folder.path() / "feature_runstatus.arff");
  const Scenario scenario = read_scenario(folder.path());
  CHECK(scenario.algorithms == std::vector<std::string>{"a"});
  CHECK(scenario.notes.size() == 2);
  CHECK(scenario.instances[1].features.size() == 3);
  CHECK(scenario.instances[1].features_cost_s == 0);
}

TEST_CASE(
    "A scenario is read as it was published: unknown limits, a comma, features of algorithms") {
  const TemporaryFolder folder;
  write_tiny(folder);
  std::string text = kDescription;
  text.replace(text.find("[more]"), 6, "\n- more\n- software");
  folder.write("description.txt",
               "algorithm_cutoff_memory: ?\n" + text +
                   "algorithm_feature_steps:\n  software:\n    provides:\n    - Lines..Total. \n"
                   "features_cutoff_time:   ? \nfeatures_stochastic:\n- ?\n");
  std::string runs = kRuns;
  runs.replace(runs.find("@DATA"), 5, "@data,");
  folder.write("algorithm_runs.arff", runs);
  const Scenario scenario = read_scenario(folder.path());
  CHECK(scenario.instances.size() == 4);
  CHECK(scenario.instances[1].features.size() == 2);
  CHECK_THAT(scenario.notes.front(),
             Contains("the features of algorithms are left out: step 'software'"));
}

TEST_CASE("A scenario that cannot be replayed is refused with the place and the cause") {
  const TemporaryFolder folder;
  write_tiny(folder);
  const auto describe = [&](const std::string& from, const std::string& to) {
    std::string text = kDescription;
    text.replace(text.find(from), from.size(), to);
    folder.write("description.txt", text);
  };
  describe("[runtime]", "[solution_quality]");
  check_scenario_refused(folder, "description.txt:3: ", "no performance_type is 'runtime'");
  describe("100", "'?'");
  check_scenario_refused(folder, "description.txt:4: ", "algorithm_cutoff_time is no time");
  describe("[more]", "[less]");
  check_scenario_refused(folder, "description.txt:", "feature step 'less' is used");
  describe("  base: {provides: [size]}", "  base: [size]");
  check_scenario_refused(folder, "description.txt:9: ", "does not say what it provides");
  describe("[more]", "[more");
  check_scenario_refused(folder, "description.txt:", "it is no YAML");
  folder.write("description.txt", kDescription);
  folder.write("algorithm_runs.arff", kRuns + "i1,1,a,10,ok\n");
  check_scenario_refused(folder, "algorithm_runs.arff:16: ", "there already");
  folder.write("algorithm_runs.arff", kRuns);
  fs::remove(folder.path() / "cv.arff");
  check_scenario_refused(folder, "cv.arff", "cannot be read");
}

TEST_CASE("A random order is the same every time, and has every number once") {
  auto order = shuffled(100);
  CHECK(order == shuffled(100));
  CHECK_FALSE(std::is_sorted(order.begin(), order.end()));
  std::sort(order.begin(), order.end());
  for (std::size_t i = 0; i < order.size(); ++i) CHECK(order[i] == i);
}

TEST_CASE("The best algorithms of four scenarios of ASlib are those of an independent computation",
          "[.][data]") {
  struct Known {
    std::string name;
    std::size_t instances;
    double single_best, virtual_best;
  };
  for (const auto& [name, instances, single_best, virtual_best] :
       std::vector<Known>{{"CSP-Minizinc-Time-2016", 100, 3372.45099, 2061.80244},
                          {"IPC2018", 240, 5459.15129, 3478.18600},
                          {"MAXSAT12-PMS", 876, 4893.14071, 3127.23629},
                          {"SAT11-HAND", 296, 25589.26883, 13360.66394}}) {
    INFO(name);
    const Scenario scenario = read_scenario(data() / name);
    CHECK(scenario.notes.empty());
    CHECK(scenario.instances.size() == instances);
    const SelectionScores scores = scores_of(scenario, std::vector<Answer>(instances));
    CHECK(scores.single_best == Approx(single_best).epsilon(1e-8));
    CHECK(scores.virtual_best == Approx(virtual_best).epsilon(1e-8));
  }
}
