#include "geodesy/hills.hpp"

#include <catch2/catch.hpp>
#include <cmath>

namespace hills_test {

using namespace reconnaissance;

TEST_CASE("Hills are a plain about the airfield, and no higher than they say elsewhere") {
  for (std::uint64_t seed = 0; seed < 5; ++seed) {
    const Hills hills(180, seed);
    double highest_m = 0;
    for (double north = -40000; north <= 40000; north += 700) {
      for (double east = -40000; east <= 40000; east += 700) {
        const double height_m = hills(north, east);
        if (std::hypot(north, east) < 9000) CHECK(height_m == 180);
        CHECK(height_m >= 180);
        CHECK(height_m <= 180 + Hills::kHighest_m);
        highest_m = std::max(highest_m, height_m);
      }
    }
    CHECK((highest_m > 280) == (seed != 0));
  }
}

TEST_CASE("A seed makes the same hills, another one others") {
  CHECK(Hills(0, 7)(20000, 12000) == Hills(0, 7)(20000, 12000));
  CHECK(Hills(0, 7)(20000, 12000) != Hills(0, 8)(20000, 12000));
}

}  // namespace hills_test
