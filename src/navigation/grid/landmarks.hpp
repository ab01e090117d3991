#pragma once

#include <array>
#include <vector>

#include "numbering.hpp"
#include "regions.hpp"

namespace skein::navigation::grid {

/// The distances from a few cells to all others. By the triangle inequality they bound what is left
/// of a way where obstacles make it much longer than the air line (Goldberg and Harrelson, SODA
/// 2005). Computed once for a map, by a search of all of its largest region for each; other regions
/// have no bound.
class Landmarks {
 public:
  Landmarks(const GridMap& map, const Numbering& numbering, const MoveCosts& costs,
            const Regions& regions, int count);

  /// Chooses those that say most about the way from `start` to `goal`; they serve bound().
  void aim(std::uint32_t start, std::uint32_t goal);

  /// No more than the cost from `cell` to the goal; consistent.
  std::uint32_t bound(std::uint32_t cell) const {
    std::uint32_t bound = 0;
    const std::uint32_t* distances = distances_.data() + std::size_t{cell} * count_;
    for (std::size_t i = 0; i < used_; ++i) {
      const std::uint32_t distance = distances[chosen_[i]];
      bound = std::max(bound, std::max(distance, at_goal_[i]) - std::min(distance, at_goal_[i]));
    }
    return bound;
  }

 private:
  static constexpr std::size_t kMaxUsed = 6;

  std::size_t count_;
  std::vector<std::uint32_t> distances_;  ///< All of a cell side by side; 0 where there is no way.
  std::size_t used_;
  std::array<std::size_t, kMaxUsed> chosen_{};
  std::array<std::uint32_t, kMaxUsed> at_goal_{};
};

}  // namespace skein::navigation::grid
