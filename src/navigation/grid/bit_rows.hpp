#pragma once

#include <bit>
#include <cstdint>
#include <cstring>
#include <vector>

#include "navigation/grid/grid_map.hpp"

namespace skein::navigation::grid {

/// What a ray along a row meets first.
struct RayEnd {
  int distance;  ///< Cells from where it began.
  bool is_turn;  ///< A free cell at which a way around an obstacle beside the row begins; else a
                 ///< blocked cell.
};

/// The rows of a plane, one bit a cell, set where it is blocked, with blocked cells around them;
/// rays look at 57 cells of three rows at a time (8 bytes from any byte on hold at least as many).
class BitRows {
 public:
  /// All cells are blocked.
  BitRows(int width, int height);

  void set_free(int x, int y) {
    bytes_[byte_of(x, y)] &= static_cast<std::uint8_t>(~(1U << (x & 7)));
  }

  bool is_free(int x, int y) const { return (bytes_[byte_of(x, y)] >> (x & 7) & 1) == 0; }

  /// Whether the cells of a row from `first` to `last`, which lie in the map, are free.
  bool are_free(int first, int last, int y) const {
    for (; last - first >= kSeen; first += kSeen) {
      if ((bits(first, y) & kSeenBits) != 0) return false;
    }
    return (bits(first, y) << (63 - (last - first))) == 0;
  }

  /// The blocked cells of the nine around and including (x, y), which lies in the map: three bits
  /// for each row, the lowest for the smallest x and y.
  unsigned blocked_around(int x, int y) const {
    const auto three = [&](int row) { return static_cast<unsigned>(bits(x - 1, row) & 7); };
    return three(y - 1) | three(y) << 3 | three(y + 1) << 6;
  }

  /// From the free cell (x, y) towards greater x. The cell itself does not end it.
  RayEnd ray_up(int x, int y) const;

  /// As ray_up(), towards smaller x.
  RayEnd ray_down(int x, int y) const;

 private:
  static constexpr int kSeen = 57;
  static constexpr std::uint64_t kSeenBits = (std::uint64_t{1} << kSeen) - 1;
  static constexpr int kMargin = 64;

  std::size_t byte_of(int x, int y) const {
    return static_cast<std::size_t>(y + 1) * row_bytes_ +
           static_cast<std::size_t>((x + kMargin) >> 3);
  }

  /// Bit 0 is cell (x, y), and kSeen bits are valid.
  std::uint64_t bits(int x, int y) const {
    std::uint64_t word;
    std::memcpy(&word, bytes_.data() + byte_of(x, y), sizeof word);
    return word >> (x & 7);
  }

  std::size_t row_bytes_;
  std::vector<std::uint8_t> bytes_;
};

/// The rows of a plane.
BitRows rows_of(const GridMap& plane);

/// The columns of a plane, as rows whose x is the plane's y.
BitRows columns_of(const GridMap& plane);

}  // namespace skein::navigation::grid
