#include "bit_rows.hpp"

namespace skein::navigation::grid {

static_assert(std::endian::native == std::endian::little,
              "a word's first byte holds its first cells");

BitRows::BitRows(int width, int height)
    : row_bytes_((static_cast<std::size_t>(width) + 2 * kMargin + 64) / 64 * 8),
      bytes_(row_bytes_ * (static_cast<std::size_t>(height) + 2) + 8, 0xff) {}

RayEnd BitRows::ray_up(int x, int y) const {
  for (int begin = x;; begin += kSeen - 1) {
    const std::uint64_t row = bits(begin, y);
    const std::uint64_t above = bits(begin, y - 1);
    const std::uint64_t below = bits(begin, y + 1);
    const std::uint64_t turns = ((above << 1) & ~above) | ((below << 1) & ~below);
    const std::uint64_t ends = (row | turns) & kSeenBits;
    if (ends == 0) continue;
    const int end = std::countr_zero(ends);
    return {begin + end - x, (row >> end & 1) == 0};
  }
}

RayEnd BitRows::ray_down(int x, int y) const {
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

BitRows rows_of(const GridMap& plane) {
  BitRows rows(plane.width(), plane.height());
  for (int y = 0; y < plane.height(); ++y) {
    for (int x = 0; x < plane.width(); ++x) {
      if (plane.is_free({x, y})) rows.set_free(x, y);
    }
  }
  return rows;
}

BitRows columns_of(const GridMap& plane) {
  BitRows columns(plane.height(), plane.width());
  for (int y = 0; y < plane.height(); ++y) {
    for (int x = 0; x < plane.width(); ++x) {
      if (plane.is_free({x, y})) columns.set_free(y, x);
    }
  }
  return columns;
}

}  // namespace skein::navigation::grid
