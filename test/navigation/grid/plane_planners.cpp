#include "exactness.hpp"
#include "skein/error.hpp"
#include "test/tools/seed.hpp"

using namespace skein;
using namespace skein::navigation::grid;
using namespace skein::navigation::grid::testing;

namespace {

/// Wider and higher than what rays see at a glance, and narrow ones.
constexpr Cell kSizes[] = {{150, 9, 1}, {9, 150, 1}, {40, 40, 1},
                           {5, 7, 1},   {1, 30, 1},  {70, 70, 1}};

/// Whether points on the lines between the corners, close to each other, lie in free cells.
bool is_clear(const GridMap& map, const GridPath& path) {
  for (std::size_t i = 1; i < path.corners.size(); ++i) {
    const Cell& a = path.corners[i - 1];
    const Cell& b = path.corners[i];
    constexpr int kPoints = 997;
    for (int point = 0; point <= kPoints; ++point) {
      const double share = static_cast<double>(point) / kPoints;
      const Cell cell{static_cast<int>(std::floor(a.x + share * (b.x - a.x) + 0.5)),
                      static_cast<int>(std::floor(a.y + share * (b.y - a.y) + 0.5))};
      if (!map.is_free(cell)) return false;
    }
  }
  return true;
}

}  // namespace

TEST_CASE("On random planes every exact planner finds what Dijkstra finds") {
  std::mt19937_64 random(test::seed_of_this_run());
  for (const Cell& size : kSizes) {
    for (int round = 0; round < 24; ++round) {
      const double density = 0.02 * round;
      const auto map =
          std::make_shared<const GridMap>(random_map(size.x, size.y, size.z, density, random));
      for (const std::string& name : grid_planner_names(*map)) {
        if (name != "theta") check_exact(map, name, random);
      }
    }
  }
}

TEST_CASE(
    "An any-angle path is no longer than the one on the grid and no shorter than the air line") {
  std::mt19937_64 random(test::seed_of_this_run());
  for (int round = 0; round < 60; ++round) {
    const auto map = std::make_shared<const GridMap>(random_map(40, 30, 1, 0.01 * round, random));
    const auto planner = make_grid_planner("theta", map);
    const Cell start = random_cell(*map, random);
    const Cell goal = random_cell(*map, random);
    const double on_grid = length_at(*map, shortest_lengths(*map, start), goal);
    const std::optional<GridPath> path = planner->plan(start, goal);
    REQUIRE(path.has_value() == std::isfinite(on_grid));
    if (!path) continue;
    CHECK(path->length <= on_grid + 1e-6);
    CHECK(path->length >= std::hypot(goal.x - start.x, goal.y - start.y) - 1e-6);
    CHECK(path->corners.front() == start);
    CHECK(path->corners.back() == goal);
    CHECK(is_clear(*map, *path));
  }
}

TEST_CASE("An any-angle path goes straight where the grid cannot") {
  const auto map = std::make_shared<const GridMap>(20, 20);
  const auto path = make_grid_planner("theta", map)->plan({0, 0}, {19, 7});
  REQUIRE(path);
  CHECK(path->corners.size() == 2);
  CHECK(path->length == Approx(std::hypot(19, 7)));
}

TEST_CASE("No path leads from, to or over blocked cells, nor past the edge") {
  auto drawn = std::make_shared<GridMap>(3, 3);
  for (const int y : {0, 1, 2}) drawn->block({1, y});
  const std::shared_ptr<const GridMap> map = drawn;
  for (const std::string& name : grid_planner_names(*map)) {
    INFO(name);
    const auto planner = make_grid_planner(name, map);
    CHECK_FALSE(planner->plan({0, 0}, {2, 2}));
    CHECK_FALSE(planner->plan({0, 0}, {1, 1}));
    CHECK_FALSE(planner->plan({1, 1}, {0, 0}));
    CHECK_FALSE(planner->plan({0, 0}, {-1, 0}));
    CHECK_FALSE(planner->plan({3, 0}, {0, 0}));
    const auto nowhere = planner->plan({2, 1}, {2, 1});
    REQUIRE(nowhere);
    CHECK(nowhere->length == 0);
    CHECK(nowhere->corners == std::vector<Cell>{{2, 1}});
  }
}

TEST_CASE("An unknown planner's name is refused with a near one") {
  const auto plane = std::make_shared<const GridMap>(2, 2);
  CHECK_THROWS_WITH(make_grid_planner("thetta", plane), Catch::Contains("did you mean 'theta'?"));
  CHECK_THROWS_AS(make_grid_planner("thetta", plane), InvalidArgument);
  const auto space = std::make_shared<const GridMap>(2, 2, 2);
  CHECK_THROWS_WITH(make_grid_planner("jps", space),
                    Catch::Contains("'jps' for a space") && Catch::Contains("canonical-astar"));
}
