#pragma once

#include <bit>
#include <cstdint>
#include <cstring>
#include <vector>

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

  /// From the free cell (x, y) towards greater x. The cell itself does not end it.
  RayEnd ray_up(int x, int y) const;

  /// As ray_up(), towards smaller x.
  RayEnd ray_down(int x, int y) const;

 private:
  static constexpr int kSeen = 57;
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

}  // namespace skein::navigation::grid
