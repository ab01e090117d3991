#include "exactness.hpp"
#include "test/tools/seed.hpp"

using namespace skein;
using namespace skein::navigation::grid;
using namespace skein::navigation::grid::testing;

TEST_CASE("In random spaces every planner finds what Dijkstra finds") {
  std::mt19937_64 random(test::seed_of_this_run());
  for (const Cell& size : {Cell{12, 11, 10}, Cell{25, 5, 4}, Cell{3, 4, 20}, Cell{2, 2, 2}}) {
    for (int round = 0; round < 24; ++round) {
      const double density = 0.025 * round;
      const auto map =
          std::make_shared<const GridMap>(random_map(size.x, size.y, size.z, density, random));
      for (const std::string& name : grid_planner_names(*map)) check_exact(map, name, random);
    }
  }
}

TEST_CASE("A diagonal through space needs its whole box free") {
  auto drawn = std::make_shared<GridMap>(2, 2, 2);
  drawn->block({1, 1, 0});
  const std::shared_ptr<const GridMap> map = drawn;
  for (const std::string& name : grid_planner_names(*map)) {
    INFO(name);
    const auto path = make_grid_planner(name, map)->plan({0, 0, 0}, {1, 1, 1});
    REQUIRE(path);
    CHECK(path->length == Approx(1 + std::sqrt(2)));
  }
}
