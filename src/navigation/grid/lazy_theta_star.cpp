#include <algorithm>
#include <array>
#include <bit>
#include <cmath>

#include "bucket_queue.hpp"
#include "grid_algorithms.hpp"
#include "moves.hpp"
#include "sight.hpp"
#include "zeroed_array.hpp"

namespace skein::navigation::grid {
namespace {

/// The moves on a plane by their place in kMoves, one bit each.
using PlaneMoves = std::uint32_t;

/// The moves that fit, by BitRows::blocked_around().
constexpr std::array<PlaneMoves, 512> all_fitting_moves() {
  std::array<PlaneMoves, 512> fitting{};
  for (unsigned blocked = 0; blocked < fitting.size(); ++blocked) {
    const Neighbourhood free = (~blocked & 0x1ffU) << neighbour_bit(-1, -1, 0);
    for (std::size_t i = 0; i < kMoveCount; ++i) {
      if (kMoves[i].fits(free)) fitting[blocked] |= PlaneMoves{1} << i;
    }
  }
  return fitting;
}

constexpr std::array<PlaneMoves, 512> kFitting = all_fitting_moves();

/// In the units of kPlaneCosts.
std::uint32_t distance(const Cell& a, const Cell& b) {
  const double dx = a.x - b.x;
  const double dy = a.y - b.y;
  return static_cast<std::uint32_t>(std::lround(kPlaneCosts.one * std::sqrt(dx * dx + dy * dy)));
}

/// Lazy Theta* (Nash, Koenig and Tovey, AAAI 2010): a cell's parent is its predecessor's parent,
/// which is checked only when the cell is expanded. The shortest path on the grid, pulled taut, is
/// found first: cells that promise nothing shorter are left out, and it is the answer where there
/// is nothing shorter.
class LazyThetaStar : public GridPlanner {
 public:
  explicit LazyThetaStar(SharedMap shared)
      : GridPlanner(shared),
        on_grid_(make_jump_point_search(std::move(shared))),
        sight_(map()),
        nodes_(static_cast<std::size_t>(map().width()) * static_cast<std::size_t>(map().height())) {
  }

 private:
  struct Node {
    std::uint32_t task;
    std::uint32_t cost;
    std::uint32_t parent;
    bool closed;
  };

  std::optional<GridPath> find_path(const Cell& start, const Cell& goal) override {
    const std::optional<GridPath> on_grid = on_grid_->plan(start, goal);
    if (!on_grid) return std::nullopt;
    GridPath taut = pulled_taut(on_grid->corners);
    if (taut.corners.size() == 2 || !search(start, goal, taut)) return taut;
    GridPath any_angle = pulled_taut(corners_to(goal));
    return any_angle.length < taut.length ? any_angle : taut;
  }

  /// Whether the goal was reached by what promised to be shorter than `known`.
  bool search(const Cell& start, const Cell& goal, const GridPath& known) {
    ++task_;
    const auto best = static_cast<std::uint32_t>(kPlaneCosts.one * known.length);
    const std::uint32_t least = distance(start, goal);
    open_.reset(least);
    nodes_[number(start)] = {task_, 0, number(start), false};
    open_.push({least, 0, number(start)});
    BucketQueue::Entry entry;
    while (open_.pop(entry)) {
      Node& node = nodes_[entry.node];
      if (node.closed || node.cost != entry.cost) continue;
      node.closed = true;
      const Cell cell = cell_at(entry.node);
      const PlaneMoves moves = kFitting[sight_.rows().blocked_around(cell.x, cell.y)];
      see_parent(node, cell, moves);
      if (cell == goal) return true;
      expand(node, cell, moves, goal, best);
    }
    return false;
  }

  void expand(const Node& node, const Cell& cell, PlaneMoves moves, const Cell& goal,
              std::uint32_t best) {
    const Cell parent = cell_at(node.parent);
    const std::uint32_t parent_cost = nodes_[node.parent].cost;
    for (; moves != 0; moves &= moves - 1) {
      const Cell to = after(cell, moves);
      Node& next = nodes_[number(to)];
      const bool is_new = next.task != task_;
      if (!is_new && (next.closed || next.parent == node.parent)) continue;
      const std::uint32_t cost = parent_cost + distance(parent, to);
      if (!is_new && next.cost <= cost) continue;
      const std::uint32_t estimate = cost + distance(to, goal);
      if (estimate >= best) continue;
      next = {task_, cost, node.parent, false};
      // A parent that was out of sight made the estimates before too high.
      open_.push({std::max(estimate, open_.least_left()), cost, number(to)});
    }
  }

  /// Where the parent is out of sight, the best closed neighbour takes its place.
  void see_parent(Node& node, const Cell& cell, PlaneMoves moves) {
    if (sight_.clear(cell_at(node.parent), cell)) return;
    node.cost = UINT32_MAX;
    for (; moves != 0; moves &= moves - 1) {
      const Cell from = after(cell, moves);
      const Node& neighbour = nodes_[number(from)];
      if (neighbour.task != task_ || !neighbour.closed) continue;
      const std::uint32_t cost = neighbour.cost + distance(from, cell);
      if (cost < node.cost) {
        node.cost = cost;
        node.parent = number(from);
      }
    }
  }

  /// By the first of the moves.
  static Cell after(const Cell& cell, PlaneMoves moves) {
    const Move& move = kMoves[static_cast<std::size_t>(std::countr_zero(moves))];
    return {cell.x + move.dx, cell.y + move.dy};
  }

  /// The path without the corners that are not needed.
  GridPath pulled_taut(const std::vector<Cell>& corners) const {
    GridPath taut{0, {corners.front()}};
    for (std::size_t i = 1; i + 1 < corners.size(); ++i) {
      if (!sight_.clear(taut.corners.back(), corners[i + 1])) taut.corners.push_back(corners[i]);
    }
    taut.corners.push_back(corners.back());
    taut.length = length_of(taut.corners);
    return taut;
  }

  std::vector<Cell> corners_to(const Cell& goal) const {
    std::vector<Cell> corners{goal};
    for (std::uint32_t node = number(goal); nodes_[node].parent != node;) {
      node = nodes_[node].parent;
      corners.push_back(cell_at(node));
    }
    std::reverse(corners.begin(), corners.end());
    return corners;
  }

  std::uint32_t number(const Cell& cell) const {
    return static_cast<std::uint32_t>(cell.x + map().width() * cell.y);
  }
  Cell cell_at(std::uint32_t number) const {
    const auto width = static_cast<std::uint32_t>(map().width());
    return {static_cast<int>(number % width), static_cast<int>(number / width)};
  }

  std::unique_ptr<GridPlanner> on_grid_;
  Sight sight_;
  ZeroedArray<Node> nodes_;
  BucketQueue open_{9};
  std::uint32_t task_ = 0;
};

}  // namespace

std::unique_ptr<GridPlanner> make_lazy_theta_star(SharedMap map) {
  return std::make_unique<LazyThetaStar>(std::move(map));
}

}  // namespace skein::navigation::grid
