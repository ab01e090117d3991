#include <algorithm>
#include <bit>

#include "bucket_queue.hpp"
#include "grid_algorithms.hpp"
#include "landmarks.hpp"
#include "numbering.hpp"
#include "pruning.hpp"
#include "regions.hpp"
#include "zeroed_array.hpp"

namespace skein::navigation::grid {
namespace {

/// Cells of a neighbourhood whose dx is -1.
constexpr Neighbourhood kColumn = 0b001001001001001001001001001;

/// A* on a map of any dimension that makes no move that Pruning leaves out, and runs on without a
/// word to the queue where only one move is left and the estimate does not grow.
class CanonicalAStar : public GridPlanner {
 public:
  CanonicalAStar(SharedMap shared, int landmarks)
      : GridPlanner(std::move(shared)),
        costs_(map().is_plane() ? kPlaneCosts : kSpaceCosts),
        regions_(map()),
        numbering_(map()),
        landmarks_(map(), numbering_, costs_, regions_, landmarks),
        classes_(numbering_.count()),
        nodes_(numbering_.count()),
        open_(map().is_plane() ? 9 : 12) {
    classify_cells();
  }

 private:
  struct Node {
    std::uint32_t task;
    std::uint32_t cost;
    std::uint32_t parent;
    MoveSet moves;  ///< To go on by.
    MoveSet done;   ///< Those of them that it has gone on by.
  };
  struct Place {
    std::uint32_t number;
    Cell cell;
  };

  /// Cells with all neighbours free keep class 0, and no memory is touched for them.
  void classify_cells() {
    for (int z = 0; z < map().depth(); ++z) {
      for (int y = 0; y < map().height(); ++y) classify_row(y, z);
    }
  }

  void classify_row(int y, int z) {
    Neighbourhood free = column(0, y, z) << 2;
    for (int x = 0; x < map().width(); ++x) {
      free = (free >> 1 & ~(kColumn << 2)) | column(x + 1, y, z) << 2;
      const bool is_free = (free >> neighbour_bit(0, 0, 0) & 1) != 0;
      if (is_free && free != kAllFree) {
        classes_[numbering_.number({x, y, z})] = pruning_.class_of(free);
      }
    }
  }

  /// The free cells of a neighbourhood whose dx is -1, moved there from `x`.
  Neighbourhood column(int x, int y, int z) const {
    Neighbourhood free = 0;
    for (int dz = -1; dz <= 1; ++dz) {
      for (int dy = -1; dy <= 1; ++dy) {
        const bool is_free = map().is_free({x, y + dy, z + dz});
        free |= Neighbourhood{is_free} << neighbour_bit(-1, dy, dz);
      }
    }
    return free;
  }

  std::optional<GridPath> find_path(const Cell& start, const Cell& goal) override {
    if (!regions_.connected(start, goal)) return std::nullopt;
    ++task_;
    goal_ = {numbering_.number(goal), goal};
    best_ = UINT32_MAX;
    const std::uint32_t first = numbering_.number(start);
    landmarks_.aim(first, goal_.number);
    const std::uint32_t least = left({first, start});
    open_.reset(least);
    nodes_[first] = {task_, 0, first, pruning_.moves_after(classes_[first], Pruning::kNoMove), 0};
    open_.push({least, 0, first});
    BucketQueue::Entry entry;
    while (open_.pop(entry)) {
      if (entry.estimate >= best_) {
        if (open_.least_left() >= best_) break;
        continue;
      }
      Node& node = nodes_[entry.node];
      if (node.cost != entry.cost) continue;
      MoveSet moves = node.moves & ~node.done;
      node.done = node.moves;
      const Place place{entry.node, numbering_.cell(entry.node)};
      for (; moves != 0; moves &= moves - 1) run(entry, place, std::countr_zero(moves));
    }
    return path();
  }

  /// No more than the cost from there to the goal.
  std::uint32_t left(const Place& place) const {
    return std::max(costs_.between(place.cell, goal_.cell), landmarks_.bound(place.number));
  }

  /// By `move` from `place` on, until there is a choice.
  void run(const BucketQueue::Entry& from, Place place, int move) {
    const Move& step = kMoves[static_cast<std::size_t>(move)];
    const std::uint32_t step_cost = costs_.along(step.axes);
    std::uint32_t cost = from.cost;
    while (true) {
      place.number += numbering_.offset(move);
      place.cell = {place.cell.x + step.dx, place.cell.y + step.dy, place.cell.z + step.dz};
      cost += step_cost;
      if (place.number == goal_.number) return reach_goal(cost, from.node);
      const MoveSet moves = pruning_.moves_after(classes_[place.number], move);
      if (moves == 0) return;
      const std::uint32_t estimate = cost + left(place);
      if (estimate >= best_) return;
      if (moves != MoveSet{1} << move || estimate > from.estimate) {
        return reach({estimate, cost, place.number}, from.node, moves);
      }
    }
  }

  void reach(const BucketQueue::Entry& entry, std::uint32_t parent, MoveSet moves) {
    Node& node = nodes_[entry.node];
    if (node.task != task_ || entry.cost < node.cost) {
      node = {task_, entry.cost, parent, moves, 0};
    } else {
      if (entry.cost > node.cost || (moves & ~node.moves) == 0) return;
      node.moves |= moves;
    }
    open_.push(entry);
  }

  void reach_goal(std::uint32_t cost, std::uint32_t parent) {
    if (cost >= best_) return;
    best_ = cost;
    nodes_[goal_.number].parent = parent;
  }

  GridPath path() const {
    GridPath path{0, {goal_.cell}};
    for (std::uint32_t node = goal_.number; nodes_[node].parent != node;) {
      node = nodes_[node].parent;
      path.corners.push_back(numbering_.cell(node));
    }
    std::reverse(path.corners.begin(), path.corners.end());
    path.length = length_of(path.corners);
    return path;
  }

  MoveCosts costs_;
  Regions regions_;
  Numbering numbering_;
  Landmarks landmarks_;
  Pruning pruning_;
  ZeroedArray<std::uint32_t> classes_;
  ZeroedArray<Node> nodes_;
  BucketQueue open_;
  std::uint32_t task_ = 0;
  Place goal_{};
  std::uint32_t best_ = 0;  ///< Cost of the best path so far.
};

}  // namespace

std::unique_ptr<GridPlanner> make_canonical_a_star(SharedMap map) {
  return std::make_unique<CanonicalAStar>(std::move(map), 0);
}

std::unique_ptr<GridPlanner> make_landmark_a_star(SharedMap map) {
  constexpr int kLandmarks = 32;
  return std::make_unique<CanonicalAStar>(std::move(map), kLandmarks);
}

}  // namespace skein::navigation::grid
