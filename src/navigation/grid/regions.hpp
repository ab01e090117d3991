#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "navigation/grid/grid_map.hpp"

namespace skein::navigation::grid {

/// Which free cells can be reached from each other. As no move cuts a corner, straight moves alone
/// reach all that can be reached; so rows are cut into runs of free cells, and runs that touch
/// belong together.
class Regions {
 public:
  explicit Regions(const GridMap& map);

  /// Both cells are free.
  bool connected(const Cell& a, const Cell& b) const { return region_of(a) == region_of(b); }

  /// A cell of the region that has the most; empty where no cell is free.
  std::optional<Cell> cell_of_largest() const;

 private:
  struct Run {
    int first;
    int last;
    std::uint32_t region;
  };

  std::size_t row_of(const Cell& cell) const;
  std::uint32_t region_of(const Cell& cell) const;
  void cut_rows(const GridMap& map);
  void join_rows(std::size_t a, std::size_t b);
  std::uint32_t root(std::uint32_t run);

  int height_;
  std::vector<Run>
      runs_;  ///< Row by row; until all are joined, `region` is a run of the same region.
  std::vector<std::uint32_t> begin_;  ///< Of each row's runs; one more than there are rows.
};

}  // namespace skein::navigation::grid
