#pragma once

#include <array>
#include <cstdint>
#include <unordered_map>
#include <vector>

#include "moves.hpp"

namespace skein::navigation::grid {

/// A set of moves: bit i stands for kMoves[i].
using MoveSet = std::uint32_t;

/// Which moves are worth making from a cell, given the move that led to it. Of all paths of the
/// same length, the one whose moves come first in kMoves (compared in order) shall survive: a move
/// is left out where the cell before and the cell after are joined by a shorter way, or by an
/// equally long one that comes first, of at most two moves among the 27 cells around. The shortest
/// path that comes first of all never makes a move that is left out, so the search stays exact.
/// Generalises jump point search's rules, which are those of a plane.
class Pruning {
 public:
  /// Stands for the move that led to the start.
  static constexpr int kNoMove = kMoveCount;

  Pruning() { class_of(kAllFree); }

  /// Neighbourhoods are known by a number; kAllFree is 0.
  std::uint32_t class_of(Neighbourhood free);

  MoveSet moves_after(std::uint32_t neighbourhood_class, int move) {
    MoveSet& moves = classes_[neighbourhood_class].after[static_cast<std::size_t>(move)];
    if (moves == kUnknown) moves = find_moves_after(classes_[neighbourhood_class].free, move);
    return moves;
  }

 private:
  static constexpr MoveSet kUnknown = UINT32_MAX;
  struct Class {
    Neighbourhood free;
    std::array<MoveSet, kMoveCount + 1> after;
  };

  static MoveSet find_moves_after(Neighbourhood free, int move);

  std::vector<Class> classes_;
  std::unordered_map<Neighbourhood, std::uint32_t> numbers_;
};

}  // namespace skein::navigation::grid
