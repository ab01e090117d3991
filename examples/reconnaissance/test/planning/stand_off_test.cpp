// From which circle a moving target is watched.
#include "planning/stand_off.hpp"

#include <catch2/catch.hpp>
#include <cmath>

#include "flight/pilot.hpp"

namespace stand_off_test {

using namespace reconnaissance;
using Catch::Contains;

namespace {

/// A target that drives eastwards, and an aircraft that flies north past it, to its left.
StandOffTask task() {
  StandOffTask task;
  task.target = {1000, 2000, 0, 8};
  task.aircraft = {0, 800, 60, 0};
  task.radius_m = 1200;
  task.greatest_distance_m = 2300;
  task.turn_radius_m = 980;
  return task;
}

double distance_m(const Circle& circle, double north_m, double east_m) {
  return std::hypot(circle.centre.north_m - north_m, circle.centre.east_m - east_m);
}

}  // namespace

TEST_CASE("a target is circled ahead of where it is, in the sense in which it is passed already") {
  StandOffTask passes = task();
  const Circle right = circle_about(passes);
  CHECK(right.radius_m == 1200);
  CHECK(right.centre.north_m == Approx(1000));
  CHECK(right.centre.east_m == Approx(2040));
  CHECK(right.clockwise);
  CHECK_FALSE(flaw_of(right, passes));
  passes.aircraft.east_m = 3000;
  CHECK_FALSE(circle_about(passes).clockwise);
}

TEST_CASE(
    "a circle beside a target is clear of all weapons, and no further off than it has to be") {
  StandOffTask near = task();
  CHECK(distance_m(*circle_beside(near), 1000, 2040) == 0);
  // 9 km to the east, and one to the south: the circle about it would reach 300 m into each.
  near.weapons = {{1000, 2040 + 9000, 8100, 0.02}, {1000 - 9000, 2040, 8100, 0.02}};
  CHECK_THAT(*flaw_of(circle_about(near), near), Contains("reach of a weapon"));
  const auto beside = circle_beside(near);
  REQUIRE(beside);
  CHECK_FALSE(flaw_of(*beside, near));
  for (const ThreatDisc& each : near.weapons)
    CHECK(distance_m(*beside, each.north_m, each.east_m) >= each.radius_m + 1200);
  CHECK(distance_m(*beside, 1000, 2040) < 800);
}

TEST_CASE("a circle beside a target is flown in the sense in which its own centre is passed") {
  StandOffTask past = task();
  // The target is ahead on the left; a weapon moves the circle to the right.
  past.aircraft = {0, 2100, 60, 0};
  past.weapons = {{1000, 2040 - 8500, 8100, 0.02}};
  CHECK_FALSE(circle_about(past).clockwise);
  const auto beside = circle_beside(past);
  REQUIRE(beside);
  CHECK(beside->centre.east_m > 2100);
  CHECK(beside->clockwise);
}

TEST_CASE("where the target could not be seen from a safe circle there is none") {
  StandOffTask deep = task();
  deep.weapons = {{1000, 2000 + 7000, 8000, 0.02}};
  CHECK_FALSE(circle_beside(deep));
  // Between two that reach nearly as far as each other there is no room.
  StandOffTask between = task();
  between.weapons = {{1000, 2000 + 9000, 8000, 0.02}, {1000, 2000 - 9000, 8000, 0.02}};
  CHECK_FALSE(circle_beside(between));
}

TEST_CASE(
    "a circle that is too tight for the aircraft, or too wide for the camera, does not serve") {
  StandOffTask tight = task();
  tight.radius_m = 900;
  CHECK_THAT(*flaw_of(circle_about(tight), tight), Contains("turns with 980"));
  StandOffTask wide = task();
  wide.radius_m = 2500;
  CHECK_THAT(*flaw_of(circle_about(wide), wide), Contains("can be seen as wanted from 2300"));
}

TEST_CASE("a pixel is as large as wanted from the greatest distance") {
  constexpr double kPixel_rad = 3.6e-5, kHeight_m = 750;
  const double distance = greatest_distance_m(0.3, kPixel_rad, kHeight_m);
  const double slant = std::hypot(distance, kHeight_m);
  CHECK(slant * kPixel_rad * slant / kHeight_m == Approx(0.3));
  CHECK(greatest_distance_m(0.01, kPixel_rad, kHeight_m) == 0);
}

TEST_CASE("who circles about a target that drives and stops keeps it at a distance") {
  // 60 m/s on L1 guidance in still air, banked at once as it wants up to 25 degrees.
  StandOffTask follow = task();
  double nearest_m = 1e9, furthest_m = 0;
  constexpr double kStep_s = 0.1;
  Motion& own = follow.aircraft;
  Circle circle;
  for (int step = 0; step < 6000; ++step) {
    const double now_s = step * kStep_s;
    follow.target.east_m_s = now_s < 200 ? 8 : now_s < 350 ? 0 : -8;
    follow.target.east_m += kStep_s * follow.target.east_m_s;
    if (step % 10 == 0) circle = circle_about(follow);
    const double bank = std::clamp(l1_bank_rad({}, own, circle), -0.4363, 0.4363);
    const double course =
        std::atan2(own.east_m_s, own.north_m_s) + kGravity_m_s2 * std::tan(bank) / 60 * kStep_s;
    own.north_m_s = 60 * std::cos(course);
    own.east_m_s = 60 * std::sin(course);
    own.north_m += kStep_s * own.north_m_s;
    own.east_m += kStep_s * own.east_m_s;
    if (now_s < 60) continue;
    const double away = map_distance_m(own, follow.target);
    nearest_m = std::min(nearest_m, away);
    furthest_m = std::max(furthest_m, away);
  }
  CHECK(nearest_m > 900);
  CHECK(furthest_m < 1500);
}

TEST_CASE("an aircraft waits about the runway, or as near to it as no weapon reaches") {
  const auto free = waiting_circle({0, 3000, 0}, {});
  REQUIRE(free);
  CHECK(free->centre.north_m == 0);
  const std::vector<ThreatDisc> weapon{{9000, 0, 8000, 0.02}};
  const auto beside = waiting_circle({0, 3000, 0}, weapon);
  REQUIRE(beside);
  CHECK(beside->centre.north_m < -1900);
  CHECK(map_distance_m(beside->centre, weapon[0]) > 8000 + beside->radius_m);
  CHECK_FALSE(waiting_circle({0, 20000, 0}, {}));
  CHECK_FALSE(waiting_circle({3000, 0, 0}, weapon));  // it is within reach
  // The weapons leave no level ground.
  CHECK_FALSE(waiting_circle(
      {-3000, 0, 0}, {{4000, 0, 9000, 0.02}, {0, -9000, 9000, 0.02}, {0, 9000, 9000, 0.02}}));
}

}  // namespace stand_off_test
