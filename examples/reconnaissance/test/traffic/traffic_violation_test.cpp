#include <catch2/catch.hpp>
#include <cmath>

#include "random.hpp"
#include "traffic/well_clear.hpp"

namespace traffic_violation_test {

using namespace reconnaissance;

namespace {

constexpr double kLookAhead_s = 180;

TrafficState anywhere(Random& random) {
  const double course = 2 * 3.14159265358979 * random.uniform();
  const double speed = 150 * random.uniform();
  return {{12'000 * (random.uniform() - 0.5), 12'000 * (random.uniform() - 0.5),
           1000 + 300 * random.uniform()},
          speed * std::cos(course),
          speed * std::sin(course),
          16 * (random.uniform() - 0.5)};
}

WellClearVolume some_volume(Random& random) { return random.happens(0.5) ? kEnRoute : kPreventive; }

struct Stepped {
  int steps = 0;
  double first_s = 0;
  double last_s = 0;
  bool gap = false;
};

Stepped step_through(const TrafficState& own, const TrafficState& other,
                     const WellClearVolume& volume, double step_s) {
  Stepped found;
  bool before = false;
  for (double t = 0; t <= kLookAhead_s; t += step_s) {
    const bool now = violates(straight_on(own, t), straight_on(other, t), volume);
    if (now && found.steps > 0 && !before) found.gap = true;
    if (now) {
      if (found.steps++ == 0) found.first_s = t;
      found.last_s = t;
    }
    before = now;
  }
  return found;
}

}  // namespace

TEST_CASE("the closed form of a violation's first and last time agrees with stepping through it") {
  constexpr double kStep_s = 0.1;
  Random random(365);
  int violated = 0;
  for (int i = 0; i < 20000; ++i) {
    const TrafficState own = anywhere(random);
    const TrafficState other = anywhere(random);
    const WellClearVolume volume = some_volume(random);
    const Stepped stepped = step_through(own, other, volume, kStep_s);
    const auto closed = violation(own, other, volume, kLookAhead_s);
    CAPTURE(i);
    REQUIRE(!stepped.gap);
    if (!closed) {
      REQUIRE(stepped.steps == 0);
    } else if (stepped.steps == 0) {
      // Too short to be met by a step.
      REQUIRE(closed->out_s - closed->in_s < kStep_s);
    } else {
      ++violated;
      REQUIRE(stepped.first_s >= closed->in_s - 1e-9);
      REQUIRE(stepped.first_s <= closed->in_s + kStep_s + 1e-9);
      REQUIRE(stepped.last_s <= closed->out_s + 1e-9);
      REQUIRE(stepped.last_s >= closed->out_s - kStep_s - 1e-9);
    }
  }
  CHECK(violated > 1000);
}

TEST_CASE("both aircraft of an encounter see the same violation") {
  Random random(366);
  for (int i = 0; i < 2000; ++i) {
    const TrafficState own = anywhere(random);
    const TrafficState other = anywhere(random);
    const auto one = violation(own, other, kEnRoute, kLookAhead_s);
    const auto two = violation(other, own, kEnRoute, kLookAhead_s);
    REQUIRE(one.has_value() == two.has_value());
    REQUIRE(violates(own, other, kEnRoute) == violates(other, own, kEnRoute));
    if (one) {
      REQUIRE(one->in_s == Approx(two->in_s));
      REQUIRE(one->out_s == Approx(two->out_s));
    }
  }
}

TEST_CASE("a head-on encounter violates well clear when modified tau falls to its threshold") {
  // Range r and closing speed c: (r² − D²) / (r c) = T has the solution r = (T c + √(T²c² +
  // 4D²))/2.
  const TrafficState own{{0, 0, 1000}, 60, 0, 0};
  const TrafficState other{{10'000, 0, 1000}, -90, 0, 0};
  const double closing_m_s = 150;
  const double tau_m = 35 * closing_m_s;
  const double distance_m = 0.66 * 1852;
  const double range_m = (tau_m + std::sqrt(tau_m * tau_m + 4 * distance_m * distance_m)) / 2;
  const auto found = violation(own, other, kEnRoute, kLookAhead_s);
  REQUIRE(found);
  CHECK(found->in_s == Approx((10'000 - range_m) / closing_m_s));
  CHECK(found->out_s == Approx((10'000 + distance_m) / closing_m_s));
}

TEST_CASE("aircraft that do not approach each other are well clear unless they are near") {
  TrafficState own{{0, 0, 1000}, 60, 0, 0};
  TrafficState other{{1222, 0, 1000}, 60, 0, 0};  // 0.66 nmi are 1222.32 m
  const auto beside = violation(own, other, kEnRoute, kLookAhead_s);
  REQUIRE(beside);
  CHECK(beside->in_s == 0);
  CHECK(beside->out_s == kLookAhead_s);
  other.place.north_m = 1223;
  CHECK(!violation(own, other, kEnRoute, kLookAhead_s));
  other.place.north_m = 1222;
  other.place.height_m = 1138;  // 450 ft are 137.16 m
  CHECK(!violation(own, other, kEnRoute, kLookAhead_s));
  CHECK(violation(own, other, kPreventive, kLookAhead_s));
  other.north_m_s = 61;
  other.place.height_m = 1000;
  CHECK(violation(own, other, kEnRoute, kLookAhead_s)->out_s == Approx(0.32).margin(0.001));
}

TEST_CASE("the least separation in closed form agrees with stepping") {
  Random random(367);
  for (int i = 0; i < 2000; ++i) {
    const TrafficState own = anywhere(random);
    const TrafficState other = anywhere(random);
    double stepped = 1e9;
    for (double t = 0; t <= kLookAhead_s; t += 0.02) {
      const TrafficState a = straight_on(own, t);
      const TrafficState b = straight_on(other, t);
      stepped = std::min(stepped, std::max(map_distance_m(a.place, b.place) / 152.4,
                                           std::abs(a.place.height_m - b.place.height_m) / 30.48));
    }
    const double closed = least_separation(own, other, 152.4, 30.48, kLookAhead_s);
    REQUIRE(closed <= stepped + 1e-9);
    // At most 300 m/s over half a step.
    REQUIRE(closed >= stepped - 300 * 0.01 / 152.4 - 16 * 0.01 / 30.48 - 1e-9);
  }
}

}  // namespace traffic_violation_test
