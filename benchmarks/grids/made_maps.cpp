#include "grids/made_maps.hpp"

#include <random>

#include "navigation/grid/grid_planner.hpp"

namespace skein::benchmarks {
namespace {

using navigation::grid::Cell;
using navigation::grid::GridMap;

constexpr int kSide = 512;

/// Engines, unlike distributions, give the same numbers with every library.
int below(int limit, std::mt19937& random) {
  return static_cast<int>(random() % static_cast<std::uint32_t>(limit));
}

GridMap scattered(int percent, std::mt19937& random) {
  GridMap map(kSide, kSide);
  for (int y = 0; y < kSide; ++y) {
    for (int x = 0; x < kSide; ++x) {
      if (below(100, random) < percent) map.block({x, y});
    }
  }
  return map;
}

/// Each cell as most of the nine around and including it; beyond the edge all is blocked.
GridMap smoothed(const GridMap& map) {
  GridMap smooth(kSide, kSide);
  for (int y = 0; y < kSide; ++y) {
    for (int x = 0; x < kSide; ++x) {
      int blocked = 0;
      for (int i = 0; i < 9; ++i) blocked += map.is_free({x + i % 3 - 1, y + i / 3 - 1}) ? 0 : 1;
      if (blocked >= 5) smooth.block({x, y});
    }
  }
  return smooth;
}

GridMap caves(std::mt19937& random) {
  GridMap map = scattered(42, random);
  for (int step = 0; step < 4; ++step) map = smoothed(map);
  return map;
}

}  // namespace

std::vector<MadeMap> made_maps() {
  std::mt19937 random(7);
  return {{"made caves", "jps", std::make_shared<const GridMap>(caves(random))},
          {"made scatter, a third blocked", "landmarks",
           std::make_shared<const GridMap>(scattered(33, random))}};
}

std::vector<navigation::grid::Scenario> made_scenarios(const std::shared_ptr<const GridMap>& map,
                                                       std::size_t count) {
  std::mt19937 random(8);
  const auto planner = navigation::grid::make_grid_planner("jps", map);
  std::vector<navigation::grid::Scenario> scenarios;
  while (scenarios.size() < count) {
    const int start_x = below(kSide, random);
    const int start_y = below(kSide, random);
    const int goal_x = below(kSide, random);
    const Cell start{start_x, start_y};
    const Cell goal{goal_x, below(kSide, random)};
    if (const auto path = planner->plan(start, goal))
      scenarios.push_back({start, goal, path->length});
  }
  return scenarios;
}

}  // namespace skein::benchmarks
