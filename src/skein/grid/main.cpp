#include <CLI/CLI.hpp>
#include <chrono>
#include <cstdio>
#include <numeric>

#include "harness/statistics.hpp"
#include "harness/turns.hpp"
#include "skein/core/error.hpp"
#include "skein/navigation/grid/grid_planner.hpp"
#include "skein/navigation/grid/scenario.hpp"

using namespace skein;
using namespace skein::navigation::grid;

namespace {

struct Arguments {
  std::string map;
  std::string scenarios;
  std::string planner;
  std::string against;
  std::size_t every = 1;
};

/// A planner, and what came out of its tasks so far.
struct Contestant {
  std::string name;
  std::unique_ptr<GridPlanner> planner;
  double preparation_ms = 0;
  std::vector<double> times_us{};
  std::size_t optimal = 0;
  std::size_t unreachable = 0;

  double mean_us() const {
    const double sum = std::accumulate(times_us.begin(), times_us.end(), 0.0);
    return times_us.empty() ? 0 : sum / static_cast<double>(times_us.size());
  }
  double p99_us() const { return benchmarks::summarize(times_us).p99; }
};

Contestant prepared(const std::string& name, const std::shared_ptr<const GridMap>& map) {
  const auto begin = std::chrono::steady_clock::now();
  auto planner = make_grid_planner(name, map);
  const std::chrono::duration<double, std::milli> taken = std::chrono::steady_clock::now() - begin;
  return {name, std::move(planner), taken.count()};
}

void plan(Contestant& contestant, const Scenario& scenario) {
  const auto begin = std::chrono::steady_clock::now();
  const std::optional<GridPath> path = contestant.planner->plan(scenario.start, scenario.goal);
  const std::chrono::duration<double, std::micro> taken = std::chrono::steady_clock::now() - begin;
  contestant.times_us.push_back(taken.count());
  const auto length = path ? std::optional(path->length) : std::nullopt;
  contestant.optimal += is_recorded_result(scenario, length) ? 1 : 0;
  contestant.unreachable += path ? 0 : 1;
}

/// For each task all contestants in a new random order, so that what disturbs the machine disturbs
/// all alike.
void plan_all(std::vector<Contestant>& contestants, const std::vector<Scenario>& scenarios,
              std::size_t every) {
  const Scenario* scenario = scenarios.data();
  std::vector<std::function<void()>> turns;
  for (Contestant& contestant : contestants) {
    turns.emplace_back([&] { plan(contestant, *scenario); });
  }
  constexpr std::uint32_t kSeed = 1;
  benchmarks::take_turns((scenarios.size() + every - 1) / every, turns, kSeed,
                         [&](std::size_t round) {
                           const std::size_t next = (round + 1) * every;
                           if (next < scenarios.size()) scenario = &scenarios[next];
                         });
}

void print_comparison(const Contestant& subject, const Contestant& rival) {
  std::printf("%s: mean_us %.3f p99_us %.3f\n", rival.name.c_str(), rival.mean_us(),
              rival.p99_us());
  std::printf("%s is faster than %s: mean %.2f times, p99 %.2f times\n", subject.name.c_str(),
              rival.name.c_str(), rival.mean_us() / subject.mean_us(),
              rival.p99_us() / subject.p99_us());
}

int run(const Arguments& arguments) {
  const auto map = std::make_shared<const GridMap>(read_grid_map(arguments.map));
  const std::vector<Scenario> scenarios = read_scenarios(arguments.scenarios, *map);
  const std::string planner =
      arguments.planner.empty() ? (map->is_plane() ? "jps" : "canonical-astar") : arguments.planner;
  std::vector<Contestant> contestants;
  contestants.push_back(prepared(planner, map));
  if (!arguments.against.empty()) contestants.push_back(prepared(arguments.against, map));
  for (const Contestant& contestant : contestants) {
    std::printf("%s: prepared in %.1f ms\n", contestant.name.c_str(), contestant.preparation_ms);
  }
  plan_all(contestants, scenarios, arguments.every);
  const Contestant& subject = contestants.front();
  if (contestants.size() > 1) print_comparison(subject, contestants.back());
  std::printf("scenarios %zu optimal %zu unreachable %zu mean_us %.3f p99_us %.3f\n",
              subject.times_us.size(), subject.optimal, subject.unreachable, subject.mean_us(),
              subject.p99_us());
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App app{"Plans every scenario of a MovingAI file, in 2-D or 3-D"};
  Arguments arguments;
  app.add_option("MAP", arguments.map, "Map (.map, .3dmap)")->required();
  app.add_option("SCENARIOS", arguments.scenarios, "Scenarios (.scen, .3dscen)")->required();
  app.add_option(
      "--planner", arguments.planner,
      "astar, canonical-astar, landmarks (2-D), jps (2-D; the default there), theta (2-D)");
  app.add_option("--against", arguments.against,
                 "A second planner, which takes turns with the first");
  app.add_option("--every", arguments.every, "Only each n-th scenario")->check(CLI::PositiveNumber);
  CLI11_PARSE(app, argc, argv);
  try {
    return run(arguments);
  } catch (const Error& error) {
    std::fprintf(stderr, "skein-grid: %s\n", error.what());
    return 2;
  }
}
