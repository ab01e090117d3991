#include "pruning.hpp"

namespace skein::navigation::grid {
namespace {

struct Offset {
  int x;
  int y;
  int z;
  bool operator==(const Offset&) const = default;
};

constexpr Offset offset_of(int bit) { return {bit % 3 - 1, bit / 3 % 3 - 1, bit / 9 - 1}; }

/// A move between two of the 27 cells, and the cells that must be free for it.
struct Passage {
  const Move* move = nullptr;  ///< Null where the two are no neighbours.
  Neighbourhood cells = 0;
};

Passage passage(const Offset& a, const Offset& b) {
  for (const Move& move : kMoves) {
    if (Offset{b.x - a.x, b.y - a.y, b.z - a.z} != Offset{move.dx, move.dy, move.dz}) continue;
    Passage passage{&move, 0};
    for (int bit = 0; bit < 27; ++bit) {
      if ((move.box >> bit & 1) == 0) continue;
      const Offset cell = offset_of(bit);
      passage.cells |= 1U << neighbour_bit(a.x + cell.x, a.y + cell.y, a.z + cell.z);
    }
    return passage;
  }
  return {};
}

/// For each pair of moves over the middle cell, the sets of cells of which one must be free for the
/// pair to be needless.
class Detours {
 public:
  Detours() {
    for (std::size_t first = 0; first < kMoveCount; ++first) {
      for (std::size_t second = 0; second < kMoveCount; ++second) {
        find(kMoves[first], kMoves[second], detours_[first][second]);
      }
    }
  }

  bool exist(std::size_t first, std::size_t second, Neighbourhood free) const {
    for (const Neighbourhood cells : detours_[first][second]) {
      if ((cells & free) == cells) return true;
    }
    return false;
  }

 private:
  static void find(const Move& first, const Move& second, std::vector<Neighbourhood>& detours) {
    const Offset from{-first.dx, -first.dy, -first.dz};
    const Offset to{second.dx, second.dy, second.dz};
    if (from == to) detours.push_back(0);
    if (const Passage direct = passage(from, to); direct.move) detours.push_back(direct.cells);
    const std::uint32_t cost = kSpaceCosts.along(first.axes) + kSpaceCosts.along(second.axes);
    for (int bit = 0; bit < 27; ++bit) {
      if (offset_of(bit) == Offset{0, 0, 0}) continue;
      const Passage there = passage(from, offset_of(bit));
      const Passage onward = passage(offset_of(bit), to);
      if (!there.move || !onward.move) continue;
      const std::uint32_t other =
          kSpaceCosts.along(there.move->axes) + kSpaceCosts.along(onward.move->axes);
      const bool comes_first = other == cost && there.move < &first;
      if (other < cost || comes_first) detours.push_back(there.cells | onward.cells);
    }
  }

  std::array<std::array<std::vector<Neighbourhood>, kMoveCount>, kMoveCount> detours_;
};

const Detours& detours() {
  static const Detours detours;
  return detours;
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
    if (move != kNoMove && detours().exist(static_cast<std::size_t>(move), next, free)) continue;
    moves |= MoveSet{1} << next;
  }
  return moves;
}

}  // namespace skein::navigation::grid
