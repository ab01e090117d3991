#include "navigation/grid/sight.hpp"

#include <algorithm>
#include <catch2/catch.hpp>
#include <cstdlib>

#include "reference.hpp"
#include "test/tools/seed.hpp"

using namespace skein;
using namespace skein::navigation::grid;
using namespace skein::navigation::grid::testing;

namespace {

/// Whether the line between the centres of `a` and `b` touches the square of `cell`, its sides
/// included: their shadows on both axes and across the line meet.
bool touches(const Cell& a, const Cell& b, const Cell& cell) {
  const auto meets = [](int from, int to, int at) {
    return 2 * std::min(from, to) <= 2 * at + 1 && 2 * at - 1 <= 2 * std::max(from, to);
  };
  if (!meets(a.x, b.x, cell.x) || !meets(a.y, b.y, cell.y)) return false;
  const int dx = b.x - a.x;
  const int dy = b.y - a.y;
  const int aside = dx * (cell.y - a.y) - dy * (cell.x - a.x);
  return 2 * std::abs(aside) <= std::abs(dx) + std::abs(dy);
}

bool clear_by_squares(const GridMap& map, const Cell& a, const Cell& b) {
  for (int y = std::min(a.y, b.y); y <= std::max(a.y, b.y); ++y) {
    for (int x = std::min(a.x, b.x); x <= std::max(a.x, b.x); ++x) {
      if (!map.is_free({x, y}) && touches(a, b, {x, y})) return false;
    }
  }
  return true;
}

}  // namespace

TEST_CASE("A line is clear where the squares of no blocked cells touch it") {
  std::mt19937_64 random(test::seed_of_this_run());
  // Longer than what is looked at in one go, and small ones with lines through corners.
  for (const Cell& size : {Cell{300, 40, 1}, Cell{40, 300, 1}, Cell{9, 9, 1}, Cell{130, 1, 1}}) {
    for (const double density : {0.0, 0.005, 0.05, 0.3}) {
      const GridMap map = random_map(size.x, size.y, 1, density, random);
      const Sight sight(map);
      for (int line = 0; line < 400; ++line) {
        const Cell a = random_cell(map, random);
        const Cell b = random_cell(map, random);
        INFO("from " << a.x << " " << a.y << " to " << b.x << " " << b.y << ", density "
                     << density);
        REQUIRE(sight.clear(a, b) == clear_by_squares(map, a, b));
      }
    }
  }
}

TEST_CASE("A line through a corner touches all four cells around it") {
  for (const Cell& blocked : {Cell{1, 0}, Cell{0, 1}, Cell{1, 1}, Cell{0, 0}}) {
    GridMap map(2, 2);
    map.block(blocked);
    CHECK_FALSE(Sight(map).clear({0, 0}, {1, 1}));
    CHECK_FALSE(Sight(map).clear({1, 0}, {0, 1}));
  }
  CHECK(Sight(GridMap(2, 2)).clear({0, 0}, {1, 1}));
}
