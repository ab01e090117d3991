#include "planning/dubins_length.hpp"

#include <catch2/catch.hpp>
#include <cmath>
#include <numbers>
#include <sstream>

#include "geodesy/local_frame.hpp"
#include "random.hpp"

namespace dubins_length_test {

using namespace reconnaissance;

namespace {

constexpr double kPi = std::numbers::pi;

RoutePose anywhere(Random& random, double extent_m) {
  const double north = extent_m * random.uniform();
  const double east = extent_m * random.uniform();
  return {north, east, 2 * kPi * random.uniform()};
}

}  // namespace

TEST_CASE("lengths are those of OMPL's Dubins space") {
  // north, east, course in degrees; the same of the goal; radius; DubinsStateSpace::distance of
  // OMPL 1.5.2.
  std::istringstream figures(R"(
377 -1004 81  383 -891 35  136  957.9464
-942 478 286  -713 -1140 206  636  1932.0738
-11643 22435 102  -10568 -18638 159  3303  55333.6814
254 188 153  156 -225 181  136  1146.8007
-2379 2370 76  -101 -4622 248  636  8773.1095
4675 -5533 20  -2604 -5177 102  3303  22659.7666
675 -915 273  720 -486 112  136  902.2067
1070 301 283  986 -922 55  636  4338.9094
24065 21631 121  -12174 5051 91  3303  45762.2647
197 101 75  74 249 161  136  1046.2914
-1977 -4821 223  -530 -2235 270  636  5933.5480
2802 3813 149  -3883 -1374 261  3303  9805.4342
-937 -933 192  -476 -738 219  136  1227.5465
-1044 -110 80  168 -465 55  636  5039.7946
-4184 -20591 210  -10160 -6345 293  3303  28464.5511
-65 55 294  236 61 312  136  1137.3184
-4485 -293 158  -4565 -3004 298  636  3513.7485
-6443 4133 162  -1819 3537 350  3303  22355.0260
-118 506 160  645 381 74  136  1330.3570
448 -774 182  413 -494 189  636  4213.1883
-2833 -21942 174  -9676 20041 139  3303  43976.2580
-190 -246 198  156 -108 341  136  879.1525
-3169 -4250 141  -83 4177 305  636  10047.1226
5057 -5492 29  -4909 -554 162  3303  17230.4551
)");
  int count = 0;
  RoutePose from, to;
  for (double radius = 0, length = 0; figures >> from.north_m >> from.east_m >> from.course_rad >>
                                      to.north_m >> to.east_m >> to.course_rad >> radius >> length;
       ++count) {
    from.course_rad *= kPi / 180;
    to.course_rad *= kPi / 180;
    CAPTURE(count);
    CHECK(dubins_length_m(from, to, radius) == Approx(length).epsilon(1e-7));
  }
  CHECK(count == 24);
}

TEST_CASE("straight on, a half circle and a place abeam have the lengths of their geometry") {
  const RoutePose origin{0, 0, 0};
  CHECK(dubins_length_m(origin, {1000, 0, 0}, 100) == Approx(1000));
  CHECK(dubins_length_m(origin, {0, 200, kPi}, 100) == Approx(100 * kPi));
  CHECK(dubins_length_m(origin, {0, -200, kPi}, 100) == Approx(100 * kPi));
  CHECK(dubins_length_m(origin, {0, 1000, kPi}, 100) == Approx(100 * kPi + 800));
  CHECK(dubins_length_m(origin, {100, 100, kPi / 2}, 100) == Approx(100 * kPi / 2));
  CHECK(dubins_length_m(origin, origin, 100) == Approx(0).margin(1e-9));
  // On the spot in the opposite direction: 7π/3 radii (three circles that touch).
  CHECK(dubins_length_m(origin, {0, 0, kPi}, 100) == Approx(100 * 7 * kPi / 3));
  // Straight on behind: a full circle and the way back to the start of it.
  CHECK(dubins_length_m(origin, {-1000, 0, 0}, 100) > 1000 + 100 * kPi);
}

TEST_CASE("lengths keep the triangle inequality, and are the same mirrored or flown backwards") {
  Random random(50);
  for (int i = 0; i < 20'000; ++i) {
    const double radius = 50 + 600 * random.uniform();
    const RoutePose a = anywhere(random, 4000);
    const RoutePose b = anywhere(random, 4000);
    const RoutePose c = anywhere(random, 4000);
    const double length = dubins_length_m(a, c, radius);
    REQUIRE(length >= map_distance_m(a, c) - 1e-6);
    REQUIRE(length <= dubins_length_m(a, b, radius) + dubins_length_m(b, c, radius) + 1e-6);
    const RoutePose mirrored_a{a.north_m, -a.east_m, -a.course_rad};
    const RoutePose mirrored_c{c.north_m, -c.east_m, -c.course_rad};
    REQUIRE(dubins_length_m(mirrored_a, mirrored_c, radius) == Approx(length));
    const RoutePose reversed_a{a.north_m, a.east_m, a.course_rad + kPi};
    const RoutePose reversed_c{c.north_m, c.east_m, c.course_rad + kPi};
    REQUIRE(dubins_length_m(reversed_c, reversed_a, radius) == Approx(length));
  }
}

}  // namespace dubins_length_test
