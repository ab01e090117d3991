#include "regions.hpp"

#include <algorithm>

namespace skein::navigation::grid {

Regions::Regions(const GridMap& map) : height_(map.height()) {
  cut_rows(map);
  for (int z = 0; z < map.depth(); ++z) {
    for (int y = 0; y < map.height(); ++y) {
      if (y > 0) join_rows(row_of({0, y, z}), row_of({0, y - 1, z}));
      if (z > 0) join_rows(row_of({0, y, z}), row_of({0, y, z - 1}));
    }
  }
  for (std::uint32_t run = 0; run < runs_.size(); ++run) runs_[run].region = root(run);
}

std::size_t Regions::row_of(const Cell& cell) const {
  return static_cast<std::size_t>(cell.y) +
         static_cast<std::size_t>(cell.z) * static_cast<std::size_t>(height_);
}

std::uint32_t Regions::region_of(const Cell& cell) const {
  const std::size_t row = row_of(cell);
  const auto after = std::upper_bound(runs_.begin() + begin_[row], runs_.begin() + begin_[row + 1],
                                      cell.x, [](int x, const Run& run) { return x < run.first; });
  return std::prev(after)->region;
}

std::optional<Cell> Regions::cell_of_largest() const {
  std::vector<int> cells(runs_.size());
  for (const Run& run : runs_) cells[run.region] += run.last - run.first + 1;
  const auto most = std::max_element(cells.begin(), cells.end());
  if (most == cells.end()) return std::nullopt;
  // The region's name is one of its runs.
  const auto run = static_cast<std::uint32_t>(most - cells.begin());
  const auto row = std::upper_bound(begin_.begin(), begin_.end(), run) - begin_.begin() - 1;
  return Cell{runs_[run].first, static_cast<int>(row) % height_, static_cast<int>(row) / height_};
}

void Regions::cut_rows(const GridMap& map) {
  for (int z = 0; z < map.depth(); ++z) {
    for (int y = 0; y < map.height(); ++y) {
      begin_.push_back(static_cast<std::uint32_t>(runs_.size()));
      for (int x = 0; x < map.width(); ++x) {
        if (!map.is_free({x, y, z})) continue;
        const bool goes_on = x > 0 && map.is_free({x - 1, y, z});
        if (goes_on) {
          runs_.back().last = x;
        } else {
          runs_.push_back({x, x, static_cast<std::uint32_t>(runs_.size())});
        }
      }
    }
  }
  begin_.push_back(static_cast<std::uint32_t>(runs_.size()));
}

void Regions::join_rows(std::size_t a, std::size_t b) {
  std::uint32_t left = begin_[a];
  std::uint32_t right = begin_[b];
  while (left < begin_[a + 1] && right < begin_[b + 1]) {
    if (runs_[left].first <= runs_[right].last && runs_[right].first <= runs_[left].last) {
      runs_[root(left)].region = root(right);
    }
    runs_[left].last < runs_[right].last ? ++left : ++right;
  }
}

std::uint32_t Regions::root(std::uint32_t run) {
  while (runs_[run].region != run) {
    runs_[run].region = runs_[runs_[run].region].region;
    run = runs_[run].region;
  }
  return run;
}

}  // namespace skein::navigation::grid
