#pragma once

#include "bit_rows.hpp"

namespace skein::navigation::grid {

/// Who sees whom on a plane.
class Sight {
 public:
  explicit Sight(const GridMap& plane) : rows_(rows_of(plane)), columns_(columns_of(plane)) {}

  /// Whether the straight line between two cells' centres touches free cells alone. A line that
  /// passes through a corner touches all four cells around it. Both cells must lie in the map.
  bool clear(const Cell& a, const Cell& b) const;

  const BitRows& rows() const { return rows_; }

 private:
  BitRows rows_;
  BitRows columns_;
};

}  // namespace skein::navigation::grid
