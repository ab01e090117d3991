#include "navigation/terrain/terrain_ceilings.hpp"

#include <algorithm>

namespace skein::navigation {

TerrainCeilings::TerrainCeilings(const Terrain& terrain)
    : rows_((terrain.rows() - 2) / kPosts + 1),
      columns_((terrain.columns() - 2) / kPosts + 1),
      north_block_m_(kPosts * terrain.north_spacing_m()),
      east_block_m_(kPosts * terrain.east_spacing_m()),
      block_m_(std::min(north_block_m_, east_block_m_)) {
  // Blocks share the posts of their borders, because the ground between two blocks depends on both.
  for (int row = 0; row < rows_; ++row) {
    for (int column = 0; column < columns_; ++column) {
      const int last_row = std::min((row + 1) * kPosts, terrain.rows() - 1);
      const int last_column = std::min((column + 1) * kPosts, terrain.columns() - 1);
      float highest = terrain.post_m(row * kPosts, column * kPosts);
      for (int i = row * kPosts; i <= last_row; ++i) {
        for (int j = column * kPosts; j <= last_column; ++j) {
          highest = std::max(highest, terrain.post_m(i, j));
        }
      }
      highest_m_.push_back(highest);
    }
  }
}

double TerrainCeilings::above(const AE_navigator::Position& a,
                              const AE_navigator::Position& b) const noexcept {
  const auto block = [](double metres, double size, int count) {
    return std::clamp(static_cast<int>(metres / size), 0, count - 1);
  };
  const int row_a = block(a.north_m, north_block_m_, rows_);
  const int row_b = block(b.north_m, north_block_m_, rows_);
  const int column_a = block(a.east_m, east_block_m_, columns_);
  const int column_b = block(b.east_m, east_block_m_, columns_);
  const auto highest = [&](int row, int column) {
    return highest_m_[static_cast<std::size_t>(row) * static_cast<std::size_t>(columns_) +
                      static_cast<std::size_t>(column)];
  };
  return std::max({highest(row_a, column_a), highest(row_a, column_b), highest(row_b, column_a),
                   highest(row_b, column_b)});
}

}  // namespace skein::navigation
