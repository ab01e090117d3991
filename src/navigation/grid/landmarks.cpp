#include "landmarks.hpp"

#include <algorithm>

#include "bucket_queue.hpp"

namespace skein::navigation::grid {
namespace {

constexpr std::uint32_t kFar = UINT32_MAX;

/// Dijkstra's search of all that can be reached; kFar for the rest.
std::vector<std::uint32_t> distances_from(const Cell& start, const GridMap& map,
                                          const Numbering& numbering, const MoveCosts& costs) {
  std::vector<std::uint32_t> distances(numbering.count(), kFar);
  BucketQueue open(9);
  distances[numbering.number(start)] = 0;
  open.reset(0);
  open.push({0, 0, numbering.number(start)});
  BucketQueue::Entry entry;
  while (open.pop(entry)) {
    if (entry.cost != distances[entry.node]) continue;
    const Neighbourhood free = neighbourhood(map, numbering.cell(entry.node));
    for (int move = 0; move < kMoveCount; ++move) {
      const Move& step = kMoves[static_cast<std::size_t>(move)];
      if (!step.fits(free)) continue;
      const std::uint32_t to = entry.node + numbering.offset(move);
      const std::uint32_t cost = entry.cost + costs.along(step.axes);
      if (cost >= distances[to]) continue;
      distances[to] = cost;
      open.push({cost, cost, to});
    }
  }
  return distances;
}

}  // namespace

Landmarks::Landmarks(const GridMap& map, const Numbering& numbering, const MoveCosts& costs,
                     const Regions& regions, int count)
    : count_(static_cast<std::size_t>(count)), used_(std::min(count_, kMaxUsed)) {
  const std::optional<Cell> anywhere = regions.cell_of_largest();
  if (count == 0 || !anywhere) {
    used_ = 0;
    return;
  }
  distances_.resize(numbering.count() * count_);
  // Each as far as can be from those before it; the first from where the search begins.
  std::vector<std::uint32_t> nearest = distances_from(*anywhere, map, numbering, costs);
  for (std::size_t landmark = 0; landmark < count_; ++landmark) {
    const auto farthest = std::max_element(
        nearest.begin(), nearest.end(),
        [](std::uint32_t a, std::uint32_t b) { return b != kFar && (a == kFar || a < b); });
    const Cell cell = numbering.cell(static_cast<std::uint32_t>(farthest - nearest.begin()));
    const std::vector<std::uint32_t> distances = distances_from(cell, map, numbering, costs);
    for (std::size_t i = 0; i < distances.size(); ++i) {
      if (distances[i] == kFar) continue;
      distances_[i * count_ + landmark] = distances[i];
      nearest[i] = landmark == 0 ? distances[i] : std::min(nearest[i], distances[i]);
    }
  }
}

void Landmarks::aim(std::uint32_t start, std::uint32_t goal) {
  if (used_ == 0) return;
  const std::uint32_t* from = distances_.data() + std::size_t{start} * count_;
  const std::uint32_t* to = distances_.data() + std::size_t{goal} * count_;
  const auto says = [&](std::size_t i) {
    return std::max(from[i], to[i]) - std::min(from[i], to[i]);
  };
  std::vector<std::size_t> order(count_);
  for (std::size_t i = 0; i < count_; ++i) order[i] = i;
  std::partial_sort(order.begin(), order.begin() + static_cast<std::ptrdiff_t>(used_), order.end(),
                    [&](std::size_t a, std::size_t b) { return says(a) > says(b); });
  for (std::size_t i = 0; i < used_; ++i) {
    chosen_[i] = order[i];
    at_goal_[i] = to[order[i]];
  }
}

}  // namespace skein::navigation::grid
