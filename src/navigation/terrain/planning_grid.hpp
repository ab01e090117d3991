#pragma once

#include <algorithm>
#include <cmath>
#include <vector>

#include "navigation/terrain/plane_geometry.hpp"
#include "navigation/terrain/terrain.hpp"

namespace skein::navigation {

/// A grid of nodes over the whole terrain, coarser than its posts; the first node is its south-west
/// corner, the last its north-east corner.
class PlanningGrid {
 public:
  /// `wanted_spacing_m` is the most that nodes are apart; 0 stands for the default of
  /// PlannerOptions.
  PlanningGrid(const Terrain& terrain, double wanted_spacing_m) {
    const double longer = std::max(terrain.north_extent_m(), terrain.east_extent_m());
    const double posts = std::max(terrain.north_spacing_m(), terrain.east_spacing_m());
    const double spacing = wanted_spacing_m > 0 ? wanted_spacing_m : std::max(longer / 256, posts);
    rows_ = std::max(2, static_cast<int>(std::ceil(terrain.north_extent_m() / spacing)) + 1);
    columns_ = std::max(2, static_cast<int>(std::ceil(terrain.east_extent_m() / spacing)) + 1);
    north_extent_m_ = terrain.north_extent_m();
    east_extent_m_ = terrain.east_extent_m();
    north_spacing_m_ = north_extent_m_ / (rows_ - 1);
    east_spacing_m_ = east_extent_m_ / (columns_ - 1);
  }

  int rows() const { return rows_; }
  int columns() const { return columns_; }
  int size() const { return rows_ * columns_; }
  double north_spacing_m() const { return north_spacing_m_; }
  double east_spacing_m() const { return east_spacing_m_; }
  double spacing_m() const { return std::max(north_spacing_m_, east_spacing_m_); }

  bool has(int row, int column) const {
    return row >= 0 && column >= 0 && row < rows_ && column < columns_;
  }
  int node(int row, int column) const { return row * columns_ + column; }
  int row(int node) const { return node / columns_; }
  int column(int node) const { return node % columns_; }
  /// Never beyond the terrain's edge, where rounding might put the last row or column.
  GroundPoint point(int node) const {
    return {std::min(row(node) * north_spacing_m_, north_extent_m_),
            std::min(column(node) * east_spacing_m_, east_extent_m_)};
  }

  /// The cell around a point: its south-western node and where in the cell the point is, 0 to 1.
  struct Cell {
    int south_west;
    double north;
    double east;
  };
  Cell cell(const GroundPoint& point) const {
    const double u = std::clamp(point.north_m / north_spacing_m_, 0.0, rows_ - 1.0);
    const double v = std::clamp(point.east_m / east_spacing_m_, 0.0, columns_ - 1.0);
    const int row = std::min(static_cast<int>(u), rows_ - 2);
    const int column = std::min(static_cast<int>(v), columns_ - 2);
    return {node(row, column), u - row, v - column};
  }

  double interpolate(const std::vector<float>& values, const GroundPoint& point) const {
    const Cell at = cell(point);
    const float* south = &values[static_cast<std::size_t>(at.south_west)];
    const float* north = south + columns_;
    return (1 - at.north) * ((1 - at.east) * south[0] + at.east * south[1]) +
           at.north * ((1 - at.east) * north[0] + at.east * north[1]);
  }

 private:
  int rows_;
  int columns_;
  double north_extent_m_;
  double east_extent_m_;
  double north_spacing_m_;
  double east_spacing_m_;
};

}  // namespace skein::navigation
