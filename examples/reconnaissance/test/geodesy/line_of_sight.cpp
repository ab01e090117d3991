#include "geodesy/line_of_sight.hpp"

#include <catch2/catch.hpp>
#include <cmath>
#include <utility>

namespace line_of_sight_test {

using namespace reconnaissance;

namespace {

double sea(double, double) { return 0; }

}  // namespace

TEST_CASE("Over the sea two places see each other up to the horizon and not beyond") {
  // Skolnik, Introduction to Radar Systems, 2001, 8.2: d = 4.12 (sqrt h_a + sqrt h_t) for radio;
  // some 3.83 km times the roots for light.
  const Local mast{0, 0, 20};
  for (const auto& [factor, of_root_m] : {std::pair(kRadioEarth, 4120), {kOpticalEarth, 3830}}) {
    for (const double height : {50.0, 300.0, 1500.0}) {
      const double horizon = of_root_m * (std::sqrt(20) + std::sqrt(height));
      CHECK(in_sight(mast, {0.98 * horizon, 0, height}, sea, factor));
      CHECK_FALSE(in_sight(mast, {1.02 * horizon, 0, height}, sea, factor));
      CHECK_FALSE(in_sight({0, 1.02 * horizon, height}, mast, sea, factor));
    }
  }
}

TEST_CASE("A ridge hides what is behind it, and not what flies above its shadow") {
  const auto ridge = [](double north_m, double) {
    return std::max(0.0, 200 - std::abs(north_m - 4000));
  };
  const Local radar{0, 0, 10};
  // The shadow's edge: 10 m at the radar, 200 m at 4 km; at 8 km 390 m, and less than 2 m of
  // curvature.
  CHECK_FALSE(in_sight(radar, {8000, 0, 380}, ridge, kRadioEarth));
  CHECK(in_sight(radar, {8000, 0, 400}, ridge, kRadioEarth));
  CHECK(in_sight(radar, {3000, 0, 100}, ridge, kRadioEarth));
  CHECK(in_sight(radar, radar, ridge, kRadioEarth));
}

}  // namespace line_of_sight_test
