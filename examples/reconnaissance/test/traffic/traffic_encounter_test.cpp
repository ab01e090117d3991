#include <catch2/catch.hpp>
#include <cmath>

#include "traffic/encounter.hpp"

namespace traffic_encounter_test {

using namespace reconnaissance;

TEST_CASE("an aircraft on collision course comes from where it is said, and would collide") {
  const TrafficState own{{100, 200, 900}, 40, 30, 0};
  for (const double direction : {0.0, 0.7, 1.5, -2.0}) {
    const auto other = on_collision_course(own, direction, 8000, 70);
    REQUIRE(other);
    CHECK(other->ground_speed_m_s() == Approx(70));
    CHECK(std::hypot(other->place.north_m - 100, other->place.east_m - 200) == Approx(8000));
    CHECK(least_separation(own, *other, 1, 1, 1000) < 1e-6);
  }
}

TEST_CASE("one that is too slow to catch up never meets") {
  CHECK_FALSE(on_collision_course({{}, 60, 0, 0}, M_PI, 5000, 50));
  CHECK(on_collision_course({{}, 60, 0, 0}, 0, 5000, 50));
  CHECK(on_collision_course({{}, 60, 0, 0}, 0, 5000, 60));
}

}  // namespace traffic_encounter_test
