#include <algorithm>
#include <cmath>
#include <limits>
#include <queue>

#include "moves.hpp"
#include "planners.hpp"
#include "sight.hpp"

namespace skein::navigation::grid {
namespace {

double distance(const Cell& a, const Cell& b) { return std::hypot(a.x - b.x, a.y - b.y); }

/// Lazy Theta* (Nash, Koenig and Tovey, AAAI 2010): a cell's parent is its predecessor's parent,
/// which is checked only when the cell is expanded. It may come out longer than the shortest path
/// on the grid; then that one is given, pulled taut.
class LazyThetaStar : public GridPlanner {
 public:
  explicit LazyThetaStar(SharedMap shared)
      : GridPlanner(shared),
        on_grid_(make_jump_point_search(std::move(shared))),
        nodes_(static_cast<std::size_t>(map().width()) * static_cast<std::size_t>(map().height())) {
  }

 private:
  struct Node {
    double cost;
    int parent;
    unsigned task;
    bool closed;
  };
  struct Open {
    double estimate;
    double cost;
    int node;
    bool operator<(const Open& other) const {
      return estimate != other.estimate ? estimate > other.estimate : cost < other.cost;
    }
  };

  std::optional<GridPath> find_path(const Cell& start, const Cell& goal) override {
    std::optional<GridPath> on_grid = on_grid_->plan(start, goal);
    if (!on_grid) return std::nullopt;
    GridPath taut = pulled_taut(*on_grid);
    GridPath any_angle = search(start, goal);
    return any_angle.length < taut.length ? any_angle : taut;
  }

  GridPath search(const Cell& start, const Cell& goal) {
    ++task_;
    std::priority_queue<Open> open;
    nodes_[index(start)] = {0, number(start), task_, false};
    open.push({distance(start, goal), 0, number(start)});
    while (true) {  // Start and goal are connected.
      const Open best = open.top();
      open.pop();
      Node& node = nodes_[static_cast<std::size_t>(best.node)];
      if (node.closed || best.cost != node.cost) continue;
      const Cell cell = cell_at(best.node);
      const Neighbourhood free = neighbourhood(map(), cell);
      node.closed = true;
      see_parent(node, cell, free);
      if (cell == goal) return path_to(best.node);
      const Cell parent = cell_at(node.parent);
      const double parent_cost = nodes_[static_cast<std::size_t>(node.parent)].cost;
      for (const Move& move : kMoves) {
        if (!move.fits(free)) continue;
        const Cell to{cell.x + move.dx, cell.y + move.dy};
        const double cost = parent_cost + distance(parent, to);
        Node& next = nodes_[index(to)];
        if (next.task == task_ && (next.closed || next.cost <= cost)) continue;
        next = {cost, node.parent, task_, false};
        open.push({cost + distance(to, goal), cost, number(to)});
      }
    }
  }

  /// Where the parent is out of sight, the best closed neighbour takes its place.
  void see_parent(Node& node, const Cell& cell, Neighbourhood free) {
    if (in_sight(map(), cell_at(node.parent), cell)) return;
    node.cost = std::numeric_limits<double>::infinity();
    for (const Move& move : kMoves) {
      if (!move.fits(free)) continue;
      const Cell from{cell.x + move.dx, cell.y + move.dy};
      const Node& neighbour = nodes_[index(from)];
      if (neighbour.task != task_ || !neighbour.closed) continue;
      const double cost = neighbour.cost + distance(from, cell);
      if (cost < node.cost) {
        node.cost = cost;
        node.parent = number(from);
      }
    }
  }

  /// Without the corners that are not needed.
  GridPath pulled_taut(const GridPath& path) const {
    GridPath taut{0, {path.corners.front()}};
    for (std::size_t i = 1; i + 1 < path.corners.size(); ++i) {
      if (!in_sight(map(), taut.corners.back(), path.corners[i + 1])) {
        taut.corners.push_back(path.corners[i]);
      }
    }
    taut.corners.push_back(path.corners.back());
    taut.length = length_of(taut.corners);
    return taut;
  }

  GridPath path_to(int last) const {
    GridPath path{0, {cell_at(last)}};
    for (int node = last; nodes_[static_cast<std::size_t>(node)].parent != node;) {
      node = nodes_[static_cast<std::size_t>(node)].parent;
      path.corners.push_back(cell_at(node));
    }
    std::reverse(path.corners.begin(), path.corners.end());
    path.length = length_of(path.corners);
    return path;
  }

  int number(const Cell& cell) const { return cell.x + map().width() * cell.y; }
  std::size_t index(const Cell& cell) const { return static_cast<std::size_t>(number(cell)); }
  Cell cell_at(int node) const { return {node % map().width(), node / map().width()}; }

  std::unique_ptr<GridPlanner> on_grid_;
  std::vector<Node> nodes_;
  unsigned task_ = 0;
};

}  // namespace

std::unique_ptr<GridPlanner> make_lazy_theta_star(SharedMap map) {
  return std::make_unique<LazyThetaStar>(std::move(map));
}

}  // namespace skein::navigation::grid
