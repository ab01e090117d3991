#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstdio>

#include "core/printable.hpp"
#include "grid_contest.hpp"
#include "skein/error.hpp"
#include "statistics.hpp"

using namespace skein;
using namespace skein::benchmarks;
using namespace skein::navigation::grid;

namespace {

constexpr std::size_t kLongestError = 4096;

struct Arguments {
  std::string map;
  std::string scenarios;
  std::string planner;
  std::string against;
  std::size_t every = 1;
};

std::vector<Scenario> each_nth(const std::vector<Scenario>& scenarios, std::size_t n) {
  std::vector<Scenario> some;
  for (std::size_t i = 0; i < scenarios.size(); i += n) some.push_back(scenarios[i]);
  return some;
}

double p99_us(const GridContestant& contestant) { return summarize(contestant.times_us).p99; }

void print_comparison(const GridContestant& subject, const GridContestant& rival) {
  std::printf("%s: mean_us %.3f p99_us %.3f\n", rival.name.c_str(), rival.mean_us(), p99_us(rival));
  std::printf("%s is faster than %s: mean %.2f times, p99 %.2f times\n", subject.name.c_str(),
              rival.name.c_str(), rival.mean_us() / subject.mean_us(),
              p99_us(rival) / p99_us(subject));
}

void print_result(const GridContestant& subject, const std::vector<Scenario>& scenarios) {
  std::size_t optimal = 0;
  for (std::size_t i = 0; i < scenarios.size(); ++i) {
    optimal += is_recorded_result(scenarios[i], subject.lengths[i]) ? 1 : 0;
  }
  const auto unreachable = std::ranges::count(subject.lengths, std::optional<double>());
  std::printf("scenarios %zu optimal %zu unreachable %td mean_us %.3f p99_us %.3f\n",
              scenarios.size(), optimal, unreachable, subject.mean_us(), p99_us(subject));
}

void run(const Arguments& arguments) {
  const auto map = std::make_shared<const GridMap>(read_grid_map(arguments.map));
  const auto scenarios = each_nth(read_scenarios(arguments.scenarios, *map), arguments.every);
  const std::string planner =
      arguments.planner.empty() ? (map->is_plane() ? "jps" : "canonical-astar") : arguments.planner;
  std::vector<GridContestant> contestants;
  contestants.push_back(prepare(planner, map));
  if (!arguments.against.empty()) contestants.push_back(prepare(arguments.against, map));
  for (const GridContestant& contestant : contestants) {
    std::printf("%s: prepared in %.1f ms\n", contestant.name.c_str(), contestant.preparation_ms);
  }
  plan_in_turns(contestants, scenarios);
  if (contestants.size() > 1) print_comparison(contestants.front(), contestants.back());
  print_result(contestants.front(), scenarios);
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App app{"Plans every scenario of a MovingAI file, in 2-D or 3-D"};
  Arguments arguments;
  app.add_option("MAP", arguments.map, "Map (.map, .3dmap)")->required();
  app.add_option("SCENARIOS", arguments.scenarios, "Scenarios (.scen, .3dscen)")->required();
  app.add_option(
      "--planner", arguments.planner,
      "astar, canonical-astar (the default in 3-D); in 2-D also jps (the default there), "
      "landmarks, theta");
  app.add_option("--against", arguments.against,
                 "A second planner, which takes turns with the first");
  app.add_option("--every", arguments.every, "Only each n-th scenario")->check(CLI::PositiveNumber);
  CLI11_PARSE(app, argc, argv);
  try {
    run(arguments);
    return 0;
  } catch (const Error& error) {
    std::fprintf(stderr, "skein-grid: %s\n", printable(error.what(), kLongestError).c_str());
    return 2;
  } catch (const std::bad_alloc&) {
    std::fprintf(stderr,
                 "skein-grid: there is not enough memory for %s and what the planner prepares; "
                 "raise the limit (ulimit -v), or take a smaller map or --planner astar\n",
                 printable(arguments.map, kLongestError).c_str());
    return 2;
  }
}
