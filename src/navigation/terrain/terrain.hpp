#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "navigation/terrain/earth_frame.hpp"

namespace skein::navigation {

/// Heights above the geoid (mean sea level) on a regular grid of posts, bilinear in between.
///
/// The frame is the one of `navigator.idl`: metres north and east of the south-west corner.
/// Immutable, so any number of threads may read one terrain at once.
class Terrain {
 public:
  /// `heights_m` holds `rows` times `columns` posts, the southernmost row first, each row from west
  /// to east. Throws InvalidArgument for fewer than two rows or columns, a spacing that is not
  /// greater than zero, a wrong number of posts, or a height that is not finite.
  Terrain(std::string name, int rows, int columns, double north_spacing_m, double east_spacing_m,
          std::vector<float> heights_m, std::optional<EarthFrame> frame = std::nullopt);

  const std::string& name() const noexcept { return name_; }
  int rows() const noexcept { return rows_; }
  int columns() const noexcept { return columns_; }
  double north_spacing_m() const noexcept { return north_spacing_m_; }
  double east_spacing_m() const noexcept { return east_spacing_m_; }
  double north_extent_m() const noexcept { return (rows_ - 1) * north_spacing_m_; }
  double east_extent_m() const noexcept { return (columns_ - 1) * east_spacing_m_; }
  float lowest_m() const noexcept { return lowest_m_; }
  float highest_m() const noexcept { return highest_m_; }

  /// Where it lies on the earth; nothing for a terrain that is invented.
  const std::optional<EarthFrame>& frame() const noexcept { return frame_; }

  /// All posts in the order of the constructor.
  const std::vector<float>& heights_m() const noexcept { return heights_m_; }
  float post_m(int row, int column) const noexcept { return heights_m_[index(row, column)]; }

  bool contains(double north_m, double east_m) const noexcept;

  /// Height at a point; beyond the edge it is the height of the nearest point of the edge.
  double height_m(double north_m, double east_m) const noexcept;

 private:
  std::size_t index(int row, int column) const noexcept {
    return static_cast<std::size_t>(row) * static_cast<std::size_t>(columns_) +
           static_cast<std::size_t>(column);
  }

  std::string name_;
  int rows_;
  int columns_;
  double north_spacing_m_;
  double east_spacing_m_;
  std::vector<float> heights_m_;
  std::optional<EarthFrame> frame_;
  float lowest_m_;
  float highest_m_;
};

/// Reads an SRTM tile: 1201 x 1201 or 3601 x 3601 big-endian 16-bit metres above the geoid (EGM96),
/// the northernmost row first; the file's name, such as `N53E027.hgt`, says where its south-west
/// corner is.
///
/// A tile is bounded by meridians and parallels, a terrain is a rectangle in metres: the largest
/// one within the tile that is symmetric about its middle meridian, of as many rows and columns.
/// Its posts are bilinear between those of the tile, and raised where one of the tile's would
/// stand above them, so that the ground is nowhere lower than a post of the tile says.
///
/// Several tiles of a folder are one terrain by a name such as `N53E027.hgt..N54E028.hgt`: all from
/// the south-western to the north-eastern one, up to 3 by 3 of the same resolution, named like
/// these; across the antimeridian, too. Of the posts that two tiles share, the higher one counts.
///
/// Connected posts without data (-32768) become as high as the highest post beside them, so that no
/// planner takes a hole in the data for a valley. Throws InvalidArgument, naming the file, where it
/// cannot be read, is named or sized otherwise, lacks tiles, which it names, lies where tiles are
/// not taken (see degree_tile.hpp), holds a height that no mountain on earth has, or holds no data
/// at all.
Terrain read_hgt(const std::filesystem::path& file);

/// Reads a DTED tile of level 0, 1 or 2 (MIL-PRF-89020B), which its headers describe; the file's
/// name does not matter. Columns may be further apart than rows, as they are away from the equator.
///
/// Laid out and filled as an SRTM tile is; a void is -32767. Throws InvalidArgument, naming the
/// file, where it cannot be read, a header is missing or says something that no such tile has, the
/// checksum or the number of a column is wrong, it lies where tiles are not taken, or it has a
/// height that no mountain on earth has or no data.
Terrain read_dted(const std::filesystem::path& file);

/// Invented mountains, the same for the same seed on every machine: 513 x 513 posts at 100 m,
/// ridges of up to some 2000 m over lowlands. Its name is `synthetic:<seed>`.
Terrain make_synthetic_terrain(std::uint32_t seed);

}  // namespace skein::navigation
