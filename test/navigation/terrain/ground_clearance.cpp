#include "navigation/terrain/ground_clearance.hpp"

#include <catch2/catch.hpp>
#include <cmath>
#include <random>

#include "test/navigation/made_terrain.hpp"

using namespace skein::navigation;
using namespace skein::navigation::testing;
using AE_navigator::Position;

TEST_CASE("An edge over a ridge between its ends is as low as above the ridge") {
  const Terrain terrain =
      make_terrain(11, 100, [](double north, double) { return north == 500 ? 300.0 : 0.0; });
  const GroundClearance lowest = ground_clearance(terrain, {50, 500, 400}, {950, 500, 400});
  CHECK(lowest.lowest_m == Approx(100));
  CHECK(lowest.at == Approx(0.5));
}

TEST_CASE("The lowest clearance inside one cell is found between its posts") {
  // A saddle: along the diagonal the ground is a parabola with its top in the middle.
  const Terrain terrain("saddle", 2, 2, 100, 100, {0, 100, 100, 0});
  const GroundClearance lowest = ground_clearance(terrain, {0, 0, 200}, {100, 100, 200});
  CHECK(lowest.lowest_m == Approx(150));
  CHECK(lowest.at == Approx(0.5));
}

TEST_CASE("No point of any edge is lower than the lowest clearance, and one is as low") {
  std::mt19937 random(3);
  std::uniform_real_distribution<double> coordinate(0, 2000), height(0, 500);
  const Terrain terrain = make_terrain(21, 100, [&](double, double) { return height(random); });
  for (int i = 0; i < 300; ++i) {
    const Position a{coordinate(random), coordinate(random), height(random)};
    const Position b{coordinate(random), coordinate(random), height(random)};
    const GroundClearance lowest = ground_clearance(terrain, a, b);
    double sampled = 1e9;
    for (int step = 0; step <= 4000; ++step) {
      const double t = step / 4000.0;
      sampled = std::min(sampled, std::lerp(a.altitude_m, b.altitude_m, t) -
                                      terrain.height_m(std::lerp(a.north_m, b.north_m, t),
                                                       std::lerp(a.east_m, b.east_m, t)));
    }
    REQUIRE(lowest.lowest_m <= sampled + 1e-6);
    REQUIRE(lowest.lowest_m > sampled - 5);
  }
}

TEST_CASE("An edge without length is as high as its point") {
  const Terrain terrain = make_terrain(3, 100, [](double, double) { return 10.0; });
  CHECK(ground_clearance(terrain, {50, 50, 60}, {50, 50, 60}).lowest_m == Approx(50));
  CHECK(ground_clearance(terrain, {100, 100, 60}, {100, 100, 60}).lowest_m == Approx(50));
}
