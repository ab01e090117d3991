#include "reference.hpp"

#include <cmath>
#include <limits>
#include <queue>

namespace skein::navigation::grid::testing {
namespace {

constexpr double kInfinite = std::numeric_limits<double>::infinity();

std::size_t index(const GridMap& map, const Cell& cell) {
  return static_cast<std::size_t>(cell.x + map.width() * (cell.y + map.height() * cell.z));
}

double distance(const Cell& a, const Cell& b) {
  return std::hypot(a.x - b.x, a.y - b.y, a.z - b.z);
}

template <class Visit>
void for_each_in_box(const Cell& a, const Cell& b, Visit visit) {
  for (int z = std::min(a.z, b.z); z <= std::max(a.z, b.z); ++z) {
    for (int y = std::min(a.y, b.y); y <= std::max(a.y, b.y); ++y) {
      for (int x = std::min(a.x, b.x); x <= std::max(a.x, b.x); ++x) visit(Cell{x, y, z});
    }
  }
}

int sign(int number) { return (number > 0) - (number < 0); }

}  // namespace

bool allowed(const GridMap& map, const Cell& from, const Cell& to) {
  bool all_free = true;
  for_each_in_box(from, to, [&](const Cell& cell) { all_free = all_free && map.is_free(cell); });
  return all_free;
}

std::vector<double> shortest_lengths(const GridMap& map, const Cell& start) {
  std::vector<double> lengths(index(map, {0, 0, map.depth()}), kInfinite);
  if (!map.is_free(start)) return lengths;
  const auto longer = [](const auto& a, const auto& b) { return a.first > b.first; };
  using Open = std::pair<double, Cell>;
  std::priority_queue<Open, std::vector<Open>, decltype(longer)> open(longer);
  lengths[index(map, start)] = 0;
  open.push({0, start});
  while (!open.empty()) {
    const auto [length, cell] = open.top();
    open.pop();
    if (length > lengths[index(map, cell)]) continue;
    const Cell first{cell.x - 1, cell.y - 1, cell.z - 1};
    const Cell last{cell.x + 1, cell.y + 1, cell.z + 1};
    for_each_in_box(first, last, [&, from = cell, so_far = length](const Cell& to) {
      if (!allowed(map, from, to)) return;
      const double longer_by = so_far + distance(from, to);
      if (longer_by >= lengths[index(map, to)]) return;
      lengths[index(map, to)] = longer_by;
      open.push({longer_by, to});
    });
  }
  return lengths;
}

double length_at(const GridMap& map, const std::vector<double>& lengths, const Cell& cell) {
  return lengths[index(map, cell)];
}

std::string fault_of(const GridMap& map, const GridPath& path, const Cell& start,
                     const Cell& goal) {
  if (path.corners.empty()) return "no corners";
  if (path.corners.front() != start) return "does not begin at the start";
  if (path.corners.back() != goal) return "does not end at the goal";
  double length = 0;
  Cell at = start;
  for (const Cell& corner : path.corners) {
    while (at != corner) {
      const Cell to{at.x + sign(corner.x - at.x), at.y + sign(corner.y - at.y),
                    at.z + sign(corner.z - at.z)};
      if (!allowed(map, at, to)) return "makes a move that is not allowed";
      length += distance(at, to);
      at = to;
    }
  }
  return std::abs(length - path.length) < 1e-6 ? "" : "is not as long as it says";
}

GridMap random_map(int width, int height, int depth, double density, std::mt19937_64& random) {
  GridMap map(width, height, depth);
  std::bernoulli_distribution blocked(density);
  for_each_in_box({0, 0, 0}, {width - 1, height - 1, depth - 1}, [&](const Cell& cell) {
    if (blocked(random)) map.block(cell);
  });
  return map;
}

Cell random_cell(const GridMap& map, std::mt19937_64& random) {
  const auto below = [&](int side) { return std::uniform_int_distribution(0, side - 1)(random); };
  return {below(map.width()), below(map.height()), below(map.depth())};
}

}  // namespace skein::navigation::grid::testing
