#include "grids/compare_grids.hpp"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <stdexcept>

#include "command/bench/grid_contest.hpp"
#include "grids/made_maps.hpp"

namespace skein::benchmarks {
namespace {

using navigation::grid::GridMap;
using navigation::grid::Scenario;

constexpr const char* kEach = "a path on a grid";
constexpr const char* kMean = "a path on a grid, mean over a map";
constexpr const char* kRival = "plain A*";

Comparison skipped(const char* planner, const char* maps) {
  Comparison comparison{kMean, planner, kRival, {{"where", maps}}};
  comparison.absence.reason = std::string("SKEIN_TEST_DATA names no folder with ") + maps;
  return comparison;
}

void require_same_lengths(const GridContestant& subject, const GridContestant& rival,
                          const std::string& where) {
  const auto same = [](const auto& a, const auto& b) {
    return a.has_value() == b.has_value() && (!a || std::abs(*a - *b) < 1e-6 * (1 + *b));
  };
  const auto [own, other] =
      std::mismatch(subject.lengths.begin(), subject.lengths.end(), rival.lengths.begin(), same);
  if (own == subject.lengths.end()) return;
  throw std::runtime_error("scenario " + std::to_string(own - subject.lengths.begin()) + " of " +
                           where + ": " + subject.name + " finds another length than " +
                           rival.name);
}

std::vector<Comparison> compare_on(const std::string& where, const std::string& planner,
                                   const std::shared_ptr<const GridMap>& map,
                                   const std::vector<Scenario>& scenarios) {
  std::vector<GridContestant> contestants;
  for (const std::string& name : {planner, std::string("astar")}) {
    contestants.push_back(prepare(name, map));
  }
  plan_in_turns(contestants, scenarios);
  const GridContestant& subject = contestants.front();
  const GridContestant& rival = contestants.back();
  require_same_lengths(subject, rival, where);
  const nlohmann::json parameters{{"where", where},
                                  {"width", map->width()},
                                  {"height", map->height()},
                                  {"depth", map->depth()},
                                  {"scenarios", scenarios.size()},
                                  {"preparation_ms", subject.preparation_ms}};
  Comparison each{kEach, "skein " + planner, kRival, parameters};
  Comparison mean{kMean, "skein " + planner, kRival, parameters};
  each.samples = subject.times_us;
  each.rival_samples = rival.times_us;
  mean.samples = {subject.mean_us()};
  mean.rival_samples = {rival.mean_us()};
  return {std::move(mean), std::move(each)};
}

std::vector<std::filesystem::path> recorded_maps(const std::string& ending) {
  const char* data = std::getenv("SKEIN_TEST_DATA");
  const auto folder = std::filesystem::path(data ? data : "") / "movingai";
  std::vector<std::filesystem::path> maps;
  if (data && std::filesystem::is_directory(folder)) {
    for (const auto& entry : std::filesystem::directory_iterator(folder)) {
      if (entry.path().extension() == ending) maps.push_back(entry.path());
    }
  }
  std::ranges::sort(maps);
  return maps;
}

std::vector<Comparison> compare_recorded(const std::string& ending,
                                         const std::string& scenario_ending, const char* planner,
                                         std::size_t every) {
  std::vector<Comparison> comparisons;
  for (const auto& file : recorded_maps(ending)) {
    const auto map = std::make_shared<const GridMap>(navigation::grid::read_grid_map(file));
    const auto all = navigation::grid::read_scenarios(file.string() + scenario_ending, *map);
    std::vector<Scenario> some;
    for (std::size_t i = 0; i < all.size(); i += every) some.push_back(all[i]);
    append(comparisons, compare_on(file.filename().string(), planner, map, some));
  }
  return comparisons;
}

}  // namespace

std::vector<Comparison> compare_grids(const GridPlan& plan) {
  std::vector<Comparison> comparisons;
  for (const MadeMap& made : made_maps()) {
    append(comparisons, compare_on(made.name, made.planner, made.map,
                                   made_scenarios(made.map, plan.made_scenarios)));
  }
  auto planes = compare_recorded(".map", ".scen", "jps", plan.every);
  if (planes.empty()) planes.push_back(skipped("skein jps", "movingai/*.map"));
  append(comparisons, std::move(planes));
  auto spaces = compare_recorded(".3dmap", ".3dscen", "canonical-astar", plan.every);
  if (spaces.empty()) spaces.push_back(skipped("skein canonical-astar", "movingai/*.3dmap"));
  append(comparisons, std::move(spaces));
  return comparisons;
}

}  // namespace skein::benchmarks
