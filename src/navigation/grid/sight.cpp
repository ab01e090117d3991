#include "sight.hpp"

#include <algorithm>
#include <cstdlib>

namespace skein::navigation::grid {
namespace {

/// As Sight::clear(), for lines that run at least as far along the rows as across them.
bool clear_along(const BitRows& rows, int ax, int ay, int bx, int by) {
  if (ay > by) {
    std::swap(ax, bx);
    std::swap(ay, by);
  }
  const long along = std::abs(bx - ax);
  const long across = by - ay;
  if (across == 0) return rows.are_free(std::min(ax, bx), std::max(ax, bx), ay);
  // The line leaves the k-th row (2k + 1) along / (2 across) cells from where it began. A cell's
  // sides belong to it: it has touched all cells up to `farthest`, rounded down, and where nothing
  // is rounded off it passes through a corner, and touches one cell more in the next row.
  const long unit = 2 * across;
  long farthest = (along + across) / unit;
  long rest = (along + across) % unit;
  const long step = 2 * along / unit;
  const long step_rest = 2 * along % unit;
  long nearest = 0;
  for (int y = ay; y <= by; ++y) {
    const int first = static_cast<int>(nearest);
    const int last = static_cast<int>(std::min(farthest, along));
    if (!(bx > ax ? rows.are_free(ax + first, ax + last, y)
                  : rows.are_free(ax - last, ax - first, y))) {
      return false;
    }
    nearest = farthest - (rest == 0 ? 1 : 0);
    farthest += step;
    rest += step_rest;
    if (rest >= unit) {
      rest -= unit;
      ++farthest;
    }
  }
  return true;
}

}  // namespace

bool Sight::clear(const Cell& a, const Cell& b) const {
  return std::abs(b.x - a.x) >= std::abs(b.y - a.y) ? clear_along(rows_, a.x, a.y, b.x, b.y)
                                                    : clear_along(columns_, a.y, a.x, b.y, b.x);
}

}  // namespace skein::navigation::grid
