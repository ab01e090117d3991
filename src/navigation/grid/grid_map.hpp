#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <vector>

namespace skein::navigation::grid {

/// A place on a grid: column, row (the first row is 0), layer. On a plane `z` is 0.
struct Cell {
  int x = 0;
  int y = 0;
  int z = 0;
  bool operator==(const Cell&) const = default;
};

/// Which cells are free, one bit a cell. A map of one layer is a plane, one of several a space.
/// Moves lead to any neighbour (8 on a plane, 26 in a space) and cost their Euclidean length; each
/// cell of a move's bounding box must be free, so that no corner is cut.
class GridMap {
 public:
  /// All cells free. Throws InvalidArgument where a side is not positive or there are 2^31 cells or
  /// more.
  GridMap(int width, int height, int depth = 1);

  int width() const { return width_; }
  int height() const { return height_; }
  int depth() const { return depth_; }
  bool is_plane() const { return depth_ == 1; }

  bool contains(const Cell& cell) const {
    return cell.x >= 0 && cell.x < width_ && cell.y >= 0 && cell.y < height_ && cell.z >= 0 &&
           cell.z < depth_;
  }

  /// False outside the map too.
  bool is_free(const Cell& cell) const {
    if (!contains(cell)) return false;
    const std::size_t bit = bit_of(cell);
    return (blocked_[bit / 64] >> (bit % 64) & 1) == 0;
  }

  /// `cell` must lie in the map.
  void block(const Cell& cell) {
    const std::size_t bit = bit_of(cell);
    blocked_[bit / 64] |= std::uint64_t{1} << (bit % 64);
  }

 private:
  std::size_t bit_of(const Cell& cell) const {
    const auto at = [](int number) { return static_cast<std::size_t>(number); };
    return at(cell.x) + at(width_) * (at(cell.y) + at(height_) * at(cell.z));
  }

  int width_;
  int height_;
  int depth_;
  std::vector<std::uint64_t> blocked_;
};

/// A map in one of the formats of movingai.com: `type octile` (a plane; `.`, `G` and `S` are free,
/// `@`, `O`, `T` and `W` are not) or `voxel` (a space: its sides, then the blocked cells), told
/// apart by its first word. Throws InvalidArgument with file, line and reason.
GridMap read_grid_map(const std::filesystem::path& file);

}  // namespace skein::navigation::grid
