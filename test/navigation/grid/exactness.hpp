#pragma once

#include <catch2/catch.hpp>
#include <cmath>

#include "reference.hpp"

namespace skein::navigation::grid::testing {

/// Plans from one cell to several with the planner of that name, and compares each result with
/// Dijkstra's.
inline void check_exact(const std::shared_ptr<const GridMap>& map, const std::string& planner_name,
                        std::mt19937_64& random) {
  const auto planner = make_grid_planner(planner_name, map);
  const Cell start = random_cell(*map, random);
  const std::vector<double> lengths = shortest_lengths(*map, start);
  for (int task = 0; task < 12; ++task) {
    const Cell goal = random_cell(*map, random);
    INFO(planner_name << " on " << map->width() << " x " << map->height() << " x " << map->depth()
                      << " from " << start.x << " " << start.y << " " << start.z << " to " << goal.x
                      << " " << goal.y << " " << goal.z);
    const std::optional<GridPath> path = planner->plan(start, goal);
    const double shortest = length_at(*map, lengths, goal);
    REQUIRE(path.has_value() == std::isfinite(shortest));
    if (!path) continue;
    REQUIRE(path->length == Approx(shortest).margin(1e-6));
    REQUIRE(fault_of(*map, *path, start, goal) == "");
  }
}

}  // namespace skein::navigation::grid::testing
