#include "navigation/threats/keep_out.hpp"

#include <catch2/catch.hpp>
#include <cmath>
#include <random>

using namespace skein::navigation;
using AE_navigator::GroundPoint;
using AE_navigator::NoFlyZone;
using AE_navigator::Position;

TEST_CASE("A cylinder is not cut by an edge between two points of an inscribed polygon") {
  const KeepOut zone({"Z", {{0, 0}}, 1000, 0, 500}, 0);
  // The chord between two points on the circle, 10 degrees apart, passes 996 m from the middle.
  const double angle = 10 * 3.14159265 / 180;
  CHECK(zone.crossed_by({1000.01, 0, 100},
                        {1000.01 * std::cos(angle), 1000.01 * std::sin(angle), 100}));
  CHECK_FALSE(zone.crossed_by({1000.01, -2000, 100}, {1000.01, 2000, 100}));
}

TEST_CASE("Whatever passes a zone stays outside of it by the buffer") {
  std::mt19937 random(11);
  std::uniform_real_distribution<double> coordinate(-3000, 3000);
  for (int round = 0; round < 40; ++round) {
    NoFlyZone zone{"Z", {}, 150.0 * (1 + round % 3), 0, 1000};
    for (int corner = 0; corner < 1 + round % 6; ++corner) {
      zone.outline.push_back({coordinate(random) / 2, coordinate(random) / 2});
    }
    const KeepOut exact(zone, 0);
    const KeepOut buffered(zone, 20);
    int passed = 0;
    for (int i = 0; i < 200; ++i) {
      const GroundPoint a{coordinate(random), coordinate(random)};
      const GroundPoint b{coordinate(random), coordinate(random)};
      double nearest = 1e9;
      for (int step = 0; step <= 200; ++step) {
        const double t = step / 200.0;
        nearest = std::min(nearest, exact.distance_m({std::lerp(a.north_m, b.north_m, t),
                                                      std::lerp(a.east_m, b.east_m, t)}));
      }
      if (buffered.crossed_on_map(a, b)) {
        REQUIRE(nearest < 20 + 45);  // Half of a step between samples.
      } else {
        ++passed;
        REQUIRE(nearest >= 20);
      }
    }
    REQUIRE(passed > 0);
  }
}

TEST_CASE("A polygon with a notch is not entered by what stays in the notch") {
  const KeepOut zone(
      {"U",
       {{0, 0}, {0, 300}, {300, 300}, {300, 200}, {100, 200}, {100, 100}, {300, 100}, {300, 0}},
       0,
       0,
       100},
      0);
  CHECK_FALSE(zone.crossed_by({400, 150, 50}, {150, 150, 50}));
  CHECK(zone.crossed_by({400, 150, 50}, {50, 150, 50}));
  CHECK(zone.contains({50, 150, 50}));
  CHECK(zone.distance_m({200, 150}) == Approx(50));
}

TEST_CASE("An edge that dives through the altitudes of a zone enters it only where it is there") {
  const KeepOut zone({"Z", {{0, 0}}, 100, 1000, 2000}, 0);
  CHECK_FALSE(zone.crossed_by({-500, 0, 900}, {500, 0, 990}));
  CHECK_FALSE(zone.crossed_by({-500, 0, 2100}, {500, 0, 2001}));
  CHECK(zone.crossed_by({-500, 0, 900}, {500, 0, 2500}));
  // Inside the altitudes only after it has passed the zone on the map.
  CHECK_FALSE(zone.crossed_by({-500, 0, 0}, {1500, 0, 1500}));
}
