#include "navigation/planners/dubins.hpp"

#include <catch2/catch.hpp>
#include <cmath>
#include <numbers>
#include <random>

#include "skein/error.hpp"

using namespace skein::navigation;
using AE_navigator::GroundPoint;

namespace {

constexpr double kPi = std::numbers::pi;

double apart(const GroundPoint& a, const GroundPoint& b) {
  return std::hypot(a.north_m - b.north_m, a.east_m - b.east_m);
}

double turned(double from, double to) { return std::abs(std::remainder(to - from, 2 * kPi)); }

/// Poses near and far, some in line, with the same heading or at the same place.
struct Task {
  Pose start;
  Pose goal;
  double radius_m;
};

Task random_task(std::mt19937& random) {
  const auto number = [&](double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(random);
  };
  Task task{{}, {}, std::pow(10.0, number(0, 3.5))};
  const double extent = task.radius_m * std::pow(10.0, number(-1, 2));
  for (Pose* pose : {&task.start, &task.goal}) {
    *pose = {{number(0, extent), number(0, extent)}, number(-kPi, kPi)};
  }
  const int kind = static_cast<int>(random() % 8);
  if (kind == 0) task.goal.heading_rad = task.start.heading_rad;
  if (kind == 1) task.goal.point = task.start.point;
  if (kind == 2) {
    const double distance = number(0, extent);
    task.goal = {{task.start.point.north_m + distance * std::cos(task.start.heading_rad),
                  task.start.point.east_m + distance * std::sin(task.start.heading_rad)},
                 task.start.heading_rad};
  }
  return task;
}

Pose reversed(const Pose& pose) { return {pose.point, pose.heading_rad + kPi}; }

}  // namespace

TEST_CASE("Known Dubins paths have their known lengths") {
  const auto length = [](const Pose& goal, double radius_m) {
    return DubinsPath({{0, 0}, 0}, goal, radius_m).length_m();
  };
  CHECK(length({{1000, 0}, 0}, 100) == Approx(1000));
  CHECK(length({{100, 100}, kPi / 2}, 100) == Approx(50 * kPi));
  CHECK(length({{0, 200}, kPi}, 100) == Approx(100 * kPi));
  CHECK(length({{0, -200}, kPi}, 100) == Approx(100 * kPi));
  CHECK(length({{0, 0}, 0}, 100) == 0);
  // About face on the spot: out by sixty degrees, around by three hundred, back by sixty.
  CHECK(length({{0, 0}, kPi}, 100) == Approx(100 * kPi * 7 / 3));
}

TEST_CASE("A Dubins path goes from pose to pose without a jump or a turn that is too tight") {
  std::mt19937 random(11);
  for (int round = 0; round < 3000; ++round) {
    const Task task = random_task(random);
    const DubinsPath path(task.start, task.goal, task.radius_m);
    const double tolerance = 1e-7 * (task.radius_m + apart(task.start.point, task.goal.point));
    CAPTURE(round, task.radius_m);
    REQUIRE(path.length_m() >= apart(task.start.point, task.goal.point) - tolerance);
    constexpr int kSteps = 300;
    const double step = path.length_m() / kSteps;
    Pose before = path.at(0);
    REQUIRE(apart(before.point, task.start.point) <= tolerance);
    for (int i = 1; i <= kSteps; ++i) {
      // Close to the end, not at it: there the goal itself would be given.
      const Pose pose = path.at(i * step * (1 - 1e-12));
      REQUIRE(apart(before.point, pose.point) <= step + tolerance);
      REQUIRE(turned(before.heading_rad, pose.heading_rad) <= step / task.radius_m + 1e-6);
      before = pose;
    }
    REQUIRE(apart(before.point, task.goal.point) <= tolerance);
    REQUIRE(turned(before.heading_rad, task.goal.heading_rad) <= 1e-6);
  }
}

TEST_CASE("A Dubins path is as long as its way back") {
  std::mt19937 random(12);
  for (int round = 0; round < 3000; ++round) {
    const Task task = random_task(random);
    const double there = DubinsPath(task.start, task.goal, task.radius_m).length_m();
    const double back =
        DubinsPath(reversed(task.goal), reversed(task.start), task.radius_m).length_m();
    CAPTURE(round);
    REQUIRE(there == Approx(back).epsilon(1e-6).margin(1e-6 * task.radius_m));
  }
}

TEST_CASE(
    "The rest of a Dubins path is the shortest from where it begins, and no detour is shorter") {
  std::mt19937 random(13);
  for (int round = 0; round < 3000; ++round) {
    const Task task = random_task(random);
    const DubinsPath path(task.start, task.goal, task.radius_m);
    const double share = std::uniform_real_distribution<double>(0, 1)(random);
    const Pose middle = path.at(share * path.length_m());
    const double rest = DubinsPath(middle, task.goal, task.radius_m).length_m();
    const double margin = 1e-6 * (task.radius_m + path.length_m());
    CAPTURE(round);
    REQUIRE(rest == Approx((1 - share) * path.length_m()).margin(margin));
    const Pose elsewhere = random_task(random).goal;
    REQUIRE(DubinsPath(task.start, elsewhere, task.radius_m).length_m() +
                DubinsPath(elsewhere, task.goal, task.radius_m).length_m() >=
            path.length_m() - margin);
  }
}

TEST_CASE("A pose for which another library gives up has a Dubins path") {
  const Pose start{{19577.925802642028, 12099.631851285438}, 1.8630325762127198};
  const Pose goal{{14344.902607243122, 29734.056912989599}, -2.6949846600427549};
  const DubinsPath path(start, goal, 60);
  CHECK(path.length_m() >= apart(start.point, goal.point));
  CHECK(path.length_m() <= apart(start.point, goal.point) + 4 * kPi * 60);
}

TEST_CASE("A Dubins path's waypoints turn gently and keep to it") {
  std::mt19937 random(14);
  for (int round = 0; round < 500; ++round) {
    const Task task = random_task(random);
    const DubinsPath path(task.start, task.goal, task.radius_m);
    const auto points = path.waypoints();
    double length = 0;
    for (std::size_t i = 1; i < points.size(); ++i) length += apart(points[i - 1], points[i]);
    CAPTURE(round);
    // Tangents of 8 degrees are longer than their arc by less than a five-hundredth.
    REQUIRE(length >= path.length_m() * (1 - 1e-9) - 1e-9);
    REQUIRE(length <= path.length_m() * 1.002 + 1e-9);
  }
}

TEST_CASE("A Dubins airplane climbs no more steeply than it may, all the way to its goal") {
  std::mt19937 random(15);
  int circling = 0, stretched = 0;
  for (int round = 0; round < 1500; ++round) {
    const Task task = random_task(random);
    const double angle = std::uniform_real_distribution<double>(3, 12)(random);
    const double climb = task.radius_m * std::uniform_real_distribution<double>(-4, 4)(random);
    const DubinsPath flat(task.start, task.goal, task.radius_m);
    const DubinsAirplanePath path({task.start, 1000}, {task.goal, 1000 + climb}, task.radius_m,
                                  angle);
    const double slope = std::tan(angle * kPi / 180);
    CAPTURE(round, angle, climb, task.radius_m);
    REQUIRE(std::abs(climb) <= slope * path.ground_length_m() * (1 + 1e-9));
    const double least = std::max(flat.length_m(), std::abs(climb) / slope);
    REQUIRE(path.ground_length_m() >= least * (1 - 1e-9));
    REQUIRE(path.ground_length_m() <= least + 2 * kPi * task.radius_m * (1 + 1e-9));
    if (path.circles() > 0 && path.circle_radius_m() > task.radius_m) {
      REQUIRE(path.ground_length_m() == Approx(least));
    }
    circling += path.circles() > 0 ? 1 : 0;
    stretched += path.path().radius_m() > task.radius_m ? 1 : 0;

    constexpr int kSteps = 300;
    const double step = path.ground_length_m() / kSteps;
    const double tolerance = 1e-6 * (task.radius_m + path.ground_length_m());
    auto before = path.at(0);
    REQUIRE(apart(before.pose.point, task.start.point) <= tolerance);
    for (int i = 1; i <= kSteps; ++i) {
      const auto now = path.at(i * step * (1 - 1e-12));
      REQUIRE(apart(before.pose.point, now.pose.point) <= step + tolerance);
      REQUIRE(turned(before.pose.heading_rad, now.pose.heading_rad) <= step / task.radius_m + 1e-5);
      REQUIRE(std::abs(now.altitude_m - before.altitude_m) <= slope * step + tolerance);
      before = now;
    }
    REQUIRE(apart(before.pose.point, task.goal.point) <= tolerance);
    REQUIRE(before.altitude_m == Approx(1000 + climb).margin(tolerance));
  }
  CHECK(circling > 100);
  CHECK(stretched > 50);
}

TEST_CASE("Without a difference of altitude a Dubins airplane flies the Dubins path") {
  std::mt19937 random(16);
  for (int round = 0; round < 200; ++round) {
    const Task task = random_task(random);
    const DubinsAirplanePath path({task.start, 700}, {task.goal, 700}, task.radius_m, 7);
    CHECK(path.length_m() == DubinsPath(task.start, task.goal, task.radius_m).length_m());
    CHECK(path.circles() == 0);
  }
}

TEST_CASE("What no aircraft can fly is refused") {
  using skein::InvalidArgument;
  CHECK_THROWS_AS(DubinsPath({{0, 0}, 0}, {{1, 0}, 0}, 0), InvalidArgument);
  CHECK_THROWS_AS(DubinsPath({{0, 0}, 0}, {{1, NAN}, 0}, 10), InvalidArgument);
  CHECK_THROWS_AS(DubinsPath({{0, 0}, INFINITY}, {{1, 0}, 0}, 10), InvalidArgument);
  const Pose here{{0, 0}, 0};
  CHECK_THROWS_AS(DubinsAirplanePath({here, 0}, {here, 10}, 10, 0), InvalidArgument);
  CHECK_THROWS_AS(DubinsAirplanePath({here, 0}, {here, 10}, 10, 90), InvalidArgument);
  CHECK_THROWS_AS(DubinsAirplanePath({here, NAN}, {here, 10}, 10, 7), InvalidArgument);
}
