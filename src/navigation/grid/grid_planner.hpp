#pragma once

#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "navigation/grid/grid_map.hpp"

namespace skein::navigation::grid {

struct GridPath {
  /// In cells' widths: the sum of the distances between the corners.
  double length = 0;
  /// From start to goal, both included; one cell where they are the same. Between two corners the
  /// way is straight, and every cell that it touches is free.
  std::vector<Cell> corners;
};

/// Plans on one map, as often as one likes: its memory is kept from one task to the next, so it is
/// for one thread at a time. Planners of the same map on several threads share the map.
/// Its whole-number costs hold paths of up to 700,000 cells' widths on a plane, 200,000 in a space.
class GridPlanner {
 public:
  virtual ~GridPlanner() = default;

  /// Empty where there is no path, as from or to a cell that is blocked or outside the map.
  std::optional<GridPath> plan(const Cell& start, const Cell& goal);

 protected:
  /// `map` must not be null.
  explicit GridPlanner(std::shared_ptr<const GridMap> map) : map_(std::move(map)) {}
  const GridMap& map() const { return *map_; }

 private:
  /// Both cells are free and not the same.
  virtual std::optional<GridPath> find_path(const Cell& start, const Cell& goal) = 0;

  std::shared_ptr<const GridMap> map_;
};

/// - `astar`: A* with a binary heap; the yardstick for the others;
/// - `canonical-astar`: A* that leaves out all but one of equally long paths, with a bucket queue;
/// - `landmarks`: the same with distances from 32 cells, which are computed when it is made (a
/// search
///   of the whole map for each; 128 bytes a cell), for maps that are full of scattered
///   obstacles, where the others look at almost every cell; planes only;
/// - `jps`: jump point search, 57 cells at a glance; planes only;
/// - `theta`: Lazy Theta* (any angle, no longer than the shortest path on the grid and some 5 %
///   shorter, in about half of `astar`'s time); planes only.
/// All but `theta` find a shortest path on the grid.
std::vector<std::string> grid_planner_names(const GridMap& map);

/// Throws InvalidArgument for a name that is not among grid_planner_names(map), and says which is
/// near.
std::unique_ptr<GridPlanner> make_grid_planner(std::string_view name,
                                               const std::shared_ptr<const GridMap>& map);

}  // namespace skein::navigation::grid
