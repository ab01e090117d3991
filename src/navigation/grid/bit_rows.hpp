#pragma once

#include <bit>
#include <cstdint>
#include <cstring>
#include <vector>

namespace skein::navigation::grid {

/// What a ray along a row meets first.
struct RayEnd {
  int distance;   ///< Cells from where it began.
  bool is_turn;  ///< A free cell at which a way around an obstacle beside the row begins; else a blocked cell.
};

/// The rows of a plane, one bit a cell, set where it is blocked, with blocked cells around them; rays look
/// at 57 cells of three rows at a time (8 bytes from any byte on hold at least as many).
class BitRows {
 public:
  BitRows(int width, int height)
      : row_bytes_((static_cast<std::size_t>(width) + 2 * kMargin + 64) / 64 * 8),
        bytes_(row_bytes_ * (static_cast<std::size_t>(height) + 2) + 8, 0xff) {
    static_assert(std::endian::native == std::endian::little);
  }

  /// Cells begin as blocked.
  void set_free(int x, int y) { bytes_[byte_of(x, y)] &= static_cast<std::uint8_t>(~(1U << (x & 7))); }

  bool is_free(int x, int y) const { return (bytes_[byte_of(x, y)] >> (x & 7) & 1) == 0; }

  /// From the free cell (x, y) towards greater x. The cell itself does not end it.
  RayEnd ray_up(int x, int y) const {
    for (int begin = x;; begin += kSeen - 1) {
      const std::uint64_t row = bits(begin, y);
      const std::uint64_t above = bits(begin, y - 1);
      const std::uint64_t below = bits(begin, y + 1);
      const std::uint64_t turns = ((above << 1) & ~above) | ((below << 1) & ~below);
      const std::uint64_t ends = (row | turns) & ((std::uint64_t{1} << kSeen) - 1);
      if (ends == 0) continue;
      const int end = std::countr_zero(ends);
      return {begin + end - x, (row >> end & 1) == 0};
    }
  }

  /// As ray_up(), towards smaller x.
  RayEnd ray_down(int x, int y) const {
    for (int begin = x;; begin -= kSeen - 1) {
      const int from = begin - (kSeen - 1);
      const std::uint64_t row = bits(from, y) << (64 - kSeen);
      const std::uint64_t above = bits(from, y - 1) << (64 - kSeen);
      const std::uint64_t below = bits(from, y + 1) << (64 - kSeen);
      const std::uint64_t turns = ((above >> 1) & ~above) | ((below >> 1) & ~below);
      const std::uint64_t ends = (row | turns) & (~std::uint64_t{0} << (64 - kSeen));
      if (ends == 0) continue;
      const int end = std::countl_zero(ends);
      return {x - begin + end, (row << end >> 63) == 0};
    }
  }

 private:
  static constexpr int kSeen = 57;
  static constexpr int kMargin = 64;

  std::size_t byte_of(int x, int y) const {
    return static_cast<std::size_t>(y + 1) * row_bytes_ + static_cast<std::size_t>((x + kMargin) >> 3);
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
