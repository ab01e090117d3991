#include "sight.hpp"

#include <cstdlib>

namespace skein::navigation::grid {

bool in_sight(const GridMap& map, const Cell& a, const Cell& b) {
  const int sides_x = std::abs(b.x - a.x);
  const int sides_y = std::abs(b.y - a.y);
  const int dx = b.x > a.x ? 1 : -1;
  const int dy = b.y > a.y ? 1 : -1;
  Cell cell = a;
  // Times at which the line crosses the next side of either kind, in units of 1 / (2 sides_x
  // sides_y).
  long next_x = sides_y;
  long next_y = sides_x;
  for (int left = sides_x + sides_y; left > 0; --left) {
    if (!map.is_free(cell)) return false;
    const bool meets_corner = next_x == next_y && sides_x > 0 && sides_y > 0;
    if (meets_corner) {
      if (!map.is_free({cell.x + dx, cell.y}) || !map.is_free({cell.x, cell.y + dy})) return false;
      --left;
    }
    const bool crosses_x = sides_x > 0 && (sides_y == 0 || next_x <= next_y);
    if (crosses_x) {
      cell.x += dx;
      next_x += 2L * sides_y;
    }
    if (!crosses_x || meets_corner) {
      cell.y += dy;
      next_y += 2L * sides_x;
    }
  }
  return map.is_free(b);
}

}  // namespace skein::navigation::grid
