// One target among all tracks: found where it was reported, followed, lost, and found again.
#include "sensing/tracking/followed_target.hpp"

#include <catch2/catch.hpp>

namespace followed_target_test {

using namespace reconnaissance;

namespace {

Track track(double north_m, double east_m, double seen_s, double east_m_s = 0) {
  Track track;
  track.number = 1;
  track.estimate.mean << north_m, east_m, 0, east_m_s;
  track.seen_s = seen_s;
  return track;
}

}  // namespace

TEST_CASE("a target is found where it was reported, and not where it was not") {
  FollowedTarget target({{1000, 2000}}, 300);
  target.look(1, {});
  CHECK_FALSE(target.found());
  target.look(2, {track(1000, 2400, 2)});
  CHECK_FALSE(target.found());
  // What was seen long ago is none, either.
  target.look(30, {track(1000, 2100, 20)});
  CHECK_FALSE(target.found());
  CHECK(target.estimate().place_m() == Eigen::Vector2d(1000, 2000));
  target.look(31, {track(1000, 2400, 31), track(1000, 2200, 31), track(1000, 1700, 31)});
  REQUIRE(target.found());
  CHECK(target.estimate().place_m() == Eigen::Vector2d(1000, 2200));
  CHECK(target.followed_s() == 0);
}

TEST_CASE("a target is found anywhere along its road, and not as far beside it") {
  FollowedTarget target({{0, 0}, {0, 1000}}, 200);
  target.look(1, {track(250, 500, 1), track(0, -250, 1)});
  CHECK_FALSE(target.found());
  SECTION("at its very end") {
    target.look(2, {track(150, 1100, 2)});
    CHECK(target.found());
  }
  SECTION("and on a longer one, once it is expected there") {
    target.look(2, {track(0, 2000, 2)});
    CHECK_FALSE(target.found());
    target.expect_along({{0, -2000}, {0, 3000}});
    target.look(3, {track(0, 2000, 3)});
    REQUIRE(target.found());
    // Then it is where it is.
    target.expect_along({{0, 0}, {0, 1000}});
    CHECK(target.estimate().place_m() == Eigen::Vector2d(0, 2000));
  }
}

TEST_CASE("of several tracks the one is followed that is where the target must be") {
  FollowedTarget target({{0, 0}}, 300);
  target.look(0, {track(0, 0, 0, 10)});
  for (int second = 1; second <= 20; ++second) {
    // One that stands beside its way, and one that comes towards it.
    target.look(second, {track(30, 100, second), track(0, 10 * second, second, 10),
                         track(0, 210 - 10 * second, second, -10)});
    if (second != 10 && second != 11) CHECK(target.estimate().mean[3] == 10);
    CHECK(target.found());
  }
  CHECK(target.followed_s() == 20);
}

TEST_CASE("a target that is not seen is expected further on, and lost after a while") {
  FollowedTarget target({{0, 0}}, 300);
  target.look(0, {track(0, 0, 0, 10)});
  for (int second = 1; second <= 15; ++second) {
    target.look(second, {});
    CHECK(target.found());
    CHECK(target.estimate().place_m()[1] == Approx(10 * second));
  }
  target.look(16, {});
  CHECK_FALSE(target.found());
  CHECK(target.followed_s() == 0);
  // It waits where the target was lost.
  target.look(60, {});
  CHECK(target.estimate().place_m()[1] == Approx(160));
  target.look(61, {track(100, 300, 61)});
  CHECK(target.found());
}

TEST_CASE("a target may have turned while it was hidden") {
  FollowedTarget target({{0, 0}}, 300);
  target.look(0, {track(0, 0, 0, 10)});
  target.look(8, {});
  // It stood: 80 m from where it would be, and 230 would be too far at once.
  target.look(9, {track(0, 5, 9)});
  CHECK(target.found());
  CHECK(target.estimate().mean[3] == 0);
  CHECK(target.followed_s() == 1);
}

}  // namespace followed_target_test
