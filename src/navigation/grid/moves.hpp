#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <cstdlib>

#include "navigation/grid/grid_map.hpp"

namespace skein::navigation::grid {

/// Free cells of the 27 around and including a cell; bit of (dx, dy, dz) is neighbour_bit().
using Neighbourhood = std::uint32_t;
constexpr Neighbourhood kAllFree = (1U << 27) - 1;

constexpr int neighbour_bit(int dx, int dy, int dz) {
  return (dx + 1) + 3 * (dy + 1) + 9 * (dz + 1);
}

struct Move {
  int dx = 0;
  int dy = 0;
  int dz = 0;
  int axes = 0;           ///< Along how many axes: 1 is straight.
  Neighbourhood box = 0;  ///< Must be free.

  constexpr bool fits(Neighbourhood free) const { return (free & box) == box; }
};

constexpr int kMoveCount = 26;

/// Those along the most axes first.
constexpr std::array<Move, kMoveCount> all_moves() {
  std::array<Move, kMoveCount> moves{};
  std::size_t count = 0;
  for (int axes = 3; axes > 0; --axes) {
    for (int bit = 0; bit < 27; ++bit) {
      Move move{bit % 3 - 1, bit / 3 % 3 - 1, bit / 9 - 1};
      move.axes = (move.dx != 0) + (move.dy != 0) + (move.dz != 0);
      if (move.axes != axes) continue;
      for (int z = std::min(0, move.dz); z <= std::max(0, move.dz); ++z) {
        for (int y = std::min(0, move.dy); y <= std::max(0, move.dy); ++y) {
          for (int x = std::min(0, move.dx); x <= std::max(0, move.dx); ++x) {
            move.box |= 1U << neighbour_bit(x, y, z);
          }
        }
      }
      moves[count++] = move;
    }
  }
  return moves;
}

constexpr std::array<Move, kMoveCount> kMoves = all_moves();

inline Neighbourhood neighbourhood(const GridMap& map, const Cell& cell) {
  Neighbourhood free = 0;
  const int layers = map.is_plane() ? 0 : 1;
  for (int dz = -layers; dz <= layers; ++dz) {
    for (int dy = -1; dy <= 1; ++dy) {
      for (int dx = -1; dx <= 1; ++dx) {
        const bool is_free = map.is_free({cell.x + dx, cell.y + dy, cell.z + dz});
        free |= Neighbourhood{is_free} << neighbour_bit(dx, dy, dz);
      }
    }
  }
  return free;
}

/// Lengths of moves along one, two and three axes, in units in which they are (nearly) whole.
struct MoveCosts {
  std::uint32_t one;
  std::uint32_t two;
  std::uint32_t three;

  constexpr std::uint32_t along(int axes) const {
    return axes == 1 ? one : axes == 2 ? two : three;
  }

  /// Of the shortest way where all is free.
  std::uint32_t between(const Cell& a, const Cell& b) const {
    auto large = static_cast<std::uint32_t>(std::abs(a.x - b.x));
    auto middle = static_cast<std::uint32_t>(std::abs(a.y - b.y));
    auto small = static_cast<std::uint32_t>(std::abs(a.z - b.z));
    if (large < middle) std::swap(large, middle);
    if (middle < small) std::swap(middle, small);
    if (large < middle) std::swap(large, middle);
    return one * (large - middle) + two * (middle - small) + three * small;
  }
};

/// 8119/5741 is a convergent of the continued fraction of sqrt(2): the order of two paths that
/// differ by less than 5741 diagonals is that of their true lengths, and on longer ones the error
/// is 1.1e-8.
constexpr MoveCosts kPlaneCosts{5741, 8119, 5741 + 8119};
/// sqrt(2) and sqrt(3) with one denominator; relative error below 1.1e-7.
constexpr MoveCosts kSpaceCosts{20586, 29113, 35656};

}  // namespace skein::navigation::grid
