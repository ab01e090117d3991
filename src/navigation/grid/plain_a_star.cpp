#include <algorithm>
#include <cmath>
#include <queue>

#include "moves.hpp"
#include "planners.hpp"

namespace skein::navigation::grid {
namespace {

constexpr double kLengths[] = {0, 1, 1.4142135623730951, 1.7320508075688772};

double shortest_where_all_is_free(const Cell& a, const Cell& b) {
  int sides[] = {std::abs(a.x - b.x), std::abs(a.y - b.y), std::abs(a.z - b.z)};
  std::sort(std::begin(sides), std::end(sides));
  return kLengths[3] * sides[0] + kLengths[2] * (sides[1] - sides[0]) +
         kLengths[1] * (sides[2] - sides[1]);
}

/// As in a textbook, but for the marks by which it need not clear its memory before each task.
class PlainAStar : public GridPlanner {
 public:
  explicit PlainAStar(SharedMap map)
      : GridPlanner(std::move(map)),
        nodes_(static_cast<std::size_t>(this->map().width()) *
               static_cast<std::size_t>(this->map().height()) *
               static_cast<std::size_t>(this->map().depth())) {}

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
    ++task_;
    std::priority_queue<Open> open;
    nodes_[index(start)] = {0, -1, task_, false};
    open.push({shortest_where_all_is_free(start, goal), 0, static_cast<int>(index(start))});
    while (!open.empty()) {
      const Open best = open.top();
      open.pop();
      const Cell cell = cell_at(best.node);
      if (cell == goal) return path_to(best.node);
      Node& node = nodes_[static_cast<std::size_t>(best.node)];
      if (node.closed) continue;
      node.closed = true;
      const Neighbourhood free = neighbourhood(map(), cell);
      for (const Move& move : kMoves) {
        if (!move.fits(free)) continue;
        const Cell to{cell.x + move.dx, cell.y + move.dy, cell.z + move.dz};
        const double cost = best.cost + kLengths[move.axes];
        Node& next = nodes_[index(to)];
        if (next.task == task_ && (next.closed || next.cost <= cost)) continue;
        next = {cost, best.node, task_, false};
        open.push({cost + shortest_where_all_is_free(to, goal), cost, static_cast<int>(index(to))});
      }
    }
    return std::nullopt;
  }

  GridPath path_to(int node) const {
    GridPath path;
    for (; node != -1; node = nodes_[static_cast<std::size_t>(node)].parent) {
      path.corners.push_back(cell_at(node));
    }
    std::reverse(path.corners.begin(), path.corners.end());
    path.length = length_of(path.corners);
    return path;
  }

  std::size_t index(const Cell& cell) const {
    return static_cast<std::size_t>(cell.x + map().width() * (cell.y + map().height() * cell.z));
  }
  Cell cell_at(int node) const {
    const int row = node / map().width();
    return {node % map().width(), row % map().height(), row / map().height()};
  }

  std::vector<Node> nodes_;
  unsigned task_ = 0;
};

}  // namespace

std::unique_ptr<GridPlanner> make_plain_a_star(SharedMap map) {
  return std::make_unique<PlainAStar>(std::move(map));
}

}  // namespace skein::navigation::grid
