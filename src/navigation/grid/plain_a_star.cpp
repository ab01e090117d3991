#include <algorithm>
#include <cmath>

#include "grid_algorithms.hpp"
#include "moves.hpp"
#include "navigation/grid/graph_search.hpp"

namespace skein::navigation::grid {
namespace {

constexpr double kLengths[] = {0, 1, 1.4142135623730951, 1.7320508075688772};

double shortest_where_all_is_free(const Cell& a, const Cell& b) {
  int sides[] = {std::abs(a.x - b.x), std::abs(a.y - b.y), std::abs(a.z - b.z)};
  std::sort(std::begin(sides), std::end(sides));
  return kLengths[3] * sides[0] + kLengths[2] * (sides[1] - sides[0]) +
         kLengths[1] * (sides[2] - sides[1]);
}

/// A map's cells, on the way to a goal, as find_cheapest_path wants them.
class CellGraph {
 public:
  CellGraph(const GridMap& map, const Cell& goal) : map_(map), goal_(goal) {}

  int node_count() const { return map_.width() * map_.height() * map_.depth(); }
  double lower_bound(int node) const { return shortest_where_all_is_free(cell(node), goal_); }

  template <class Visit>
  void for_each_edge(int node, Visit&& visit) const {
    const Cell from = cell(node);
    const Neighbourhood free = neighbourhood(map_, from);
    for (const Move& move : kMoves) {
      if (!move.fits(free)) continue;
      visit(number({from.x + move.dx, from.y + move.dy, from.z + move.dz}), kLengths[move.axes]);
    }
  }

  int number(const Cell& cell) const {
    return cell.x + map_.width() * (cell.y + map_.height() * cell.z);
  }
  Cell cell(int node) const {
    const int row = node / map_.width();
    return {node % map_.width(), row % map_.height(), row / map_.height()};
  }

 private:
  const GridMap& map_;
  Cell goal_;
};

class PlainAStar : public GridPlanner {
 public:
  explicit PlainAStar(SharedMap map) : GridPlanner(std::move(map)) {}

 private:
  std::optional<GridPath> find_path(const Cell& start, const Cell& goal) override {
    const CellGraph graph(map(), goal);
    const SearchResult found =
        find_cheapest_path(graph, graph.number(start), graph.number(goal), {}, memory_);
    if (found.end != SearchEnd::Found) return std::nullopt;
    GridPath path;
    for (const int node : found.path.nodes) path.corners.push_back(graph.cell(node));
    path.length = length_of(path.corners);
    return path;
  }

  SearchMemory memory_;
};

}  // namespace

std::unique_ptr<GridPlanner> make_plain_a_star(SharedMap map) {
  return std::make_unique<PlainAStar>(std::move(map));
}

}  // namespace skein::navigation::grid
