#pragma once

#include <vector>

#include "navigation/terrain/terrain.hpp"
#include "navigator.idl.hpp"

namespace skein::navigation {

/// The highest post of every block of a terrain: tells quickly that a ray passes far above the
/// ground.
class TerrainCeilings {
 public:
  static constexpr int kPosts = 8;  ///< Posts along the side of a block.

  explicit TerrainCeilings(const Terrain& terrain);

  /// The shorter side of a block, in metres.
  double block_m() const noexcept { return block_m_; }

  /// No ground below the edge is higher; for edges no longer than a block.
  double above(const AE_navigator::Position& a, const AE_navigator::Position& b) const noexcept;

 private:
  int rows_;
  int columns_;
  double north_block_m_;
  double east_block_m_;
  double block_m_;
  std::vector<float> highest_m_;
};

}  // namespace skein::navigation
