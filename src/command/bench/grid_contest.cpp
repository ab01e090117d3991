#include "command/bench/grid_contest.hpp"

#include <chrono>
#include <functional>
#include <numeric>

#include "random_turns.hpp"

namespace skein::benchmarks {
namespace {

using std::chrono::steady_clock;

template <class Period>
double since(steady_clock::time_point begin) {
  return std::chrono::duration<double, Period>(steady_clock::now() - begin).count();
}

void plan(GridContestant& contestant, const navigation::grid::Scenario& scenario) {
  const auto begin = steady_clock::now();
  const auto path = contestant.planner->plan(scenario.start, scenario.goal);
  contestant.times_us.push_back(since<std::micro>(begin));
  contestant.lengths.push_back(path ? std::optional(path->length) : std::nullopt);
}

}  // namespace

double GridContestant::mean_us() const {
  const double sum = std::accumulate(times_us.begin(), times_us.end(), 0.0);
  return times_us.empty() ? 0 : sum / static_cast<double>(times_us.size());
}

GridContestant prepare(const std::string& name,
                       const std::shared_ptr<const navigation::grid::GridMap>& map) {
  const auto begin = steady_clock::now();
  auto planner = navigation::grid::make_grid_planner(name, map);
  return {name, std::move(planner), since<std::milli>(begin)};
}

void plan_in_turns(std::vector<GridContestant>& contestants,
                   const std::vector<navigation::grid::Scenario>& scenarios) {
  std::size_t scenario = 0;
  std::vector<std::function<void()>> turns;
  for (GridContestant& contestant : contestants) {
    turns.emplace_back([&] { plan(contestant, scenarios[scenario]); });
  }
  constexpr std::uint32_t kSeed = 1;
  take_turns(scenarios.size(), turns, kSeed, "", [&](std::size_t round) { scenario = round + 1; });
}

}  // namespace skein::benchmarks
