#include <algorithm>
#include <bit>

#include "bit_rows.hpp"
#include "bucket_queue.hpp"
#include "grid_algorithms.hpp"
#include "moves.hpp"
#include "regions.hpp"
#include "zeroed_array.hpp"

namespace skein::navigation::grid {
namespace {

/// The eight directions, clockwise on a map whose first row is on top; odd ones are diagonal.
constexpr int kDx[] = {1, 1, 0, -1, -1, -1, 0, 1};
constexpr int kDy[] = {0, 1, 1, 1, 0, -1, -1, -1};
constexpr unsigned kAllDirections = 0xff;

constexpr unsigned direction_bit(int direction) { return 1U << (direction & 7); }

/// Jump point search (Harabor and Grastien, AAAI 2011) by the rules without corner cutting, where
/// only straight rays meet turns. Points at which a diagonal ray sends out straight ones are not
/// put into the queue, but their straight rays' ends. Ends met from several directions at the same
/// cost go on in the directions of all.
class JumpPointSearch : public GridPlanner {
 public:
  explicit JumpPointSearch(SharedMap shared)
      : GridPlanner(std::move(shared)),
        regions_(map()),
        rows_(rows_of(map())),
        columns_(columns_of(map())),
        nodes_(static_cast<std::size_t>(map().width()) * static_cast<std::size_t>(map().height())) {
  }

 private:
  struct Node {
    std::uint32_t task;
    std::uint32_t cost;
    std::uint32_t parent;
    std::uint8_t directions;  ///< To go on in.
    std::uint8_t done;        ///< Those of them that it has gone on in.
  };

  std::optional<GridPath> find_path(const Cell& start, const Cell& goal) override {
    if (!regions_.connected(start, goal)) return std::nullopt;
    ++task_;
    goal_ = goal;
    best_ = UINT32_MAX;
    const std::uint32_t least = kPlaneCosts.between(start, goal);
    open_.reset(least);
    nodes_[index(start.x, start.y)] = {task_, 0, index(start.x, start.y), kAllDirections, 0};
    open_.push({least, 0, index(start.x, start.y)});
    BucketQueue::Entry entry;
    while (open_.pop(entry)) {
      if (entry.estimate >= best_) {
        if (open_.least_left() >= best_) break;
        continue;
      }
      Node& node = nodes_[entry.node];
      if (node.cost != entry.cost) continue;
      const unsigned directions = node.directions & ~static_cast<unsigned>(node.done);
      node.done = node.directions;
      expand(entry, directions);
    }
    return path();
  }

  void expand(const BucketQueue::Entry& entry, unsigned directions) {
    const auto width = static_cast<std::uint32_t>(map().width());
    const Origin origin{static_cast<int>(entry.node % width), static_cast<int>(entry.node / width),
                        entry.cost, entry.node};
    while (directions != 0) {
      const int direction = std::countr_zero(directions);
      directions &= directions - 1;
      if (direction % 2 == 0) {
        go_straight(origin, direction);
      } else {
        go_diagonally(origin, direction);
      }
    }
  }

  struct Origin {
    int x;
    int y;
    std::uint32_t cost;
    std::uint32_t parent;
  };

  void go_diagonally(Origin at, int direction) {
    const int dx = kDx[direction];
    const int dy = kDy[direction];
    const int along_x = dx > 0 ? 0 : 4;
    const int along_y = dy > 0 ? 2 : 6;
    while (rows_.is_free(at.x + dx, at.y) && rows_.is_free(at.x, at.y + dy) &&
           rows_.is_free(at.x + dx, at.y + dy)) {
      at.x += dx;
      at.y += dy;
      at.cost += kPlaneCosts.two;
      if (at.x == goal_.x && at.y == goal_.y) {
        reach_goal(at.cost, at.parent);
        return;
      }
      if (at.cost + kPlaneCosts.between({at.x, at.y}, goal_) >= best_) return;
      go_straight(at, along_x);
      go_straight(at, along_y);
    }
  }

  void go_straight(const Origin& at, int direction) {
    const int dx = kDx[direction];
    const int dy = kDy[direction];
    const RayEnd end = direction == 0   ? rows_.ray_up(at.x, at.y)
                       : direction == 4 ? rows_.ray_down(at.x, at.y)
                       : direction == 2 ? columns_.ray_up(at.y, at.x)
                                        : columns_.ray_down(at.y, at.x);
    const bool goal_in_line = dx != 0 ? goal_.y == at.y : goal_.x == at.x;
    if (goal_in_line) {
      const int distance = (goal_.x - at.x) * dx + (goal_.y - at.y) * dy;
      if (distance > 0 && distance <= end.distance) {
        reach_goal(at.cost + kPlaneCosts.one * static_cast<std::uint32_t>(distance), at.parent);
        return;
      }
    }
    if (!end.is_turn) return;
    reach(at.x + dx * end.distance, at.y + dy * end.distance,
          at.cost + kPlaneCosts.one * static_cast<std::uint32_t>(end.distance), at.parent,
          direction);
  }

  /// The end of a straight ray.
  void reach(int x, int y, std::uint32_t cost, std::uint32_t parent, int direction) {
    const std::uint32_t number = index(x, y);
    Node& node = nodes_[number];
    const bool is_new = node.task != task_;
    if (!is_new && cost > node.cost) return;
    const std::uint32_t estimate = cost + kPlaneCosts.between({x, y}, goal_);
    if (estimate >= best_) return;
    const unsigned directions = directions_from(x, y, direction);
    if (is_new || cost < node.cost) {
      node = {task_, cost, parent, static_cast<std::uint8_t>(directions), 0};
    } else {
      if ((directions & ~static_cast<unsigned>(node.directions)) == 0) return;
      node.directions |= static_cast<std::uint8_t>(directions);
    }
    open_.push({estimate, cost, number});
  }

  /// On ahead, and around the obstacles that end beside the cell before.
  unsigned directions_from(int x, int y, int direction) const {
    unsigned directions = direction_bit(direction);
    for (const int side : {-2, 2}) {
      const int across = (direction + side) & 7;
      const int beside_x = x + kDx[across];
      const int beside_y = y + kDy[across];
      if (rows_.is_free(beside_x, beside_y) &&
          !rows_.is_free(beside_x - kDx[direction], beside_y - kDy[direction])) {
        directions |= direction_bit(across) | direction_bit(direction + side / 2);
      }
    }
    return directions;
  }

  void reach_goal(std::uint32_t cost, std::uint32_t parent) {
    if (cost >= best_) return;
    best_ = cost;
    nodes_[index(goal_.x, goal_.y)].parent = parent;
  }

  /// Each node was reached from its parent diagonally first, then straight.
  GridPath path() const {
    const auto width = static_cast<std::uint32_t>(map().width());
    GridPath path{0, {goal_}};
    for (std::uint32_t node = index(goal_.x, goal_.y); nodes_[node].parent != node;) {
      node = nodes_[node].parent;
      const Cell to = path.corners.back();
      const Cell from{static_cast<int>(node % width), static_cast<int>(node / width)};
      const int dx = to.x - from.x;
      const int dy = to.y - from.y;
      const int diagonals = std::min(std::abs(dx), std::abs(dy));
      if (diagonals > 0 && std::abs(dx) != std::abs(dy)) {
        path.corners.push_back({from.x + (dx > 0 ? diagonals : -diagonals),
                                from.y + (dy > 0 ? diagonals : -diagonals)});
      }
      path.corners.push_back(from);
    }
    std::reverse(path.corners.begin(), path.corners.end());
    path.length = length_of(path.corners);
    return path;
  }

  std::uint32_t index(int x, int y) const {
    return static_cast<std::uint32_t>(x + map().width() * y);
  }

  Regions regions_;
  BitRows rows_;
  BitRows columns_;
  ZeroedArray<Node> nodes_;
  BucketQueue open_{9};
  std::uint32_t task_ = 0;
  Cell goal_;
  std::uint32_t best_ = 0;  ///< Cost of the best path so far.
};

}  // namespace

std::unique_ptr<GridPlanner> make_jump_point_search(SharedMap map) {
  return std::make_unique<JumpPointSearch>(std::move(map));
}

}  // namespace skein::navigation::grid
