#include "pruning.hpp"

namespace skein::navigation::grid {
namespace {

struct Offset {
  int x;
  int y;
  int z;
  bool operator==(const Offset&) const = default;
};

/// The move between two of the 27 cells; null where they are no neighbours, the same, or it does
/// not fit.
const Move* move_between(const Offset& a, const Offset& b, Neighbourhood free) {
  const Offset step{b.x - a.x, b.y - a.y, b.z - a.z};
  for (const Move& move : kMoves) {
    if (step != Offset{move.dx, move.dy, move.dz}) continue;
    for (int bit = 0; bit < 27; ++bit) {
      if ((move.box >> bit & 1) == 0) continue;
      const int cell = neighbour_bit(a.x + bit % 3 - 1, a.y + bit / 3 % 3 - 1, a.z + bit / 9 - 1);
      if ((free >> cell & 1) == 0) return nullptr;
    }
    return &move;
  }
  return nullptr;
}

/// Whether the way over the middle cell, by `first` and `second`, can be left out.
bool is_needless(const Move& first, const Move& second, Neighbourhood free) {
  const Offset from{-first.dx, -first.dy, -first.dz};
  const Offset to{second.dx, second.dy, second.dz};
  if (from == to || move_between(from, to, free)) return true;
  const std::uint32_t cost = kSpaceCosts.along(first.axes) + kSpaceCosts.along(second.axes);
  for (int bit = 0; bit < 27; ++bit) {
    const Offset over{bit % 3 - 1, bit / 3 % 3 - 1, bit / 9 - 1};
    if (over == Offset{0, 0, 0}) continue;
    const Move* other = move_between(from, over, free);
    const Move* onward = other ? move_between(over, to, free) : nullptr;
    if (!onward) continue;
    const std::uint32_t other_cost =
        kSpaceCosts.along(other->axes) + kSpaceCosts.along(onward->axes);
    if (other_cost < cost || (other_cost == cost && other < &first)) return true;
  }
  return false;
}

}  // namespace

std::uint32_t Pruning::class_of(Neighbourhood free) {
  const auto [known, is_new] =
      numbers_.try_emplace(free, static_cast<std::uint32_t>(classes_.size()));
  if (is_new) {
    classes_.push_back({free, {}});
    classes_.back().after.fill(kUnknown);
  }
  return known->second;
}

MoveSet Pruning::find_moves_after(Neighbourhood free, int move) {
  MoveSet moves = 0;
  for (std::size_t next = 0; next < kMoveCount; ++next) {
    if (!kMoves[next].fits(free)) continue;
    if (move != kNoMove &&
        is_needless(kMoves[static_cast<std::size_t>(move)], kMoves[next], free)) {
      continue;
    }
    moves |= MoveSet{1} << next;
  }
  return moves;
}

}  // namespace skein::navigation::grid
