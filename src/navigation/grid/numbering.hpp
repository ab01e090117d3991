#pragma once

#include <array>

#include "moves.hpp"

namespace skein::navigation::grid {

/// Numbers of cells with a margin of one cell around the map, so that a move is an offset.
class Numbering {
 public:
  explicit Numbering(const GridMap& map)
      : width_(static_cast<std::uint32_t>(map.width()) + 2),
        height_(static_cast<std::uint32_t>(map.height()) + 2),
        count_(std::size_t{width_} * height_ * (static_cast<std::size_t>(map.depth()) + 2)) {
    for (std::size_t i = 0; i < kMoveCount; ++i) {
      const Move& move = kMoves[i];
      offsets_[i] = static_cast<std::uint32_t>(
          move.dx + static_cast<int>(width_) * (move.dy + static_cast<int>(height_) * move.dz));
    }
  }

  std::size_t count() const { return count_; }
  std::uint32_t offset(int move) const { return offsets_[static_cast<std::size_t>(move)]; }
  std::uint32_t number(const Cell& cell) const {
    const auto at = [](int side) { return static_cast<std::uint32_t>(side + 1); };
    return at(cell.x) + width_ * (at(cell.y) + height_ * at(cell.z));
  }
  Cell cell(std::uint32_t number) const {
    const std::uint32_t row = number / width_;
    return {static_cast<int>(number % width_) - 1, static_cast<int>(row % height_) - 1,
            static_cast<int>(row / height_) - 1};
  }

 private:
  std::uint32_t width_;
  std::uint32_t height_;
  std::size_t count_;
  std::array<std::uint32_t, kMoveCount> offsets_{};
};

}  // namespace skein::navigation::grid
