#include "navigation/planners/dubins.hpp"

#include <catch2/catch.hpp>
#include <cmath>
#include <numbers>
#include <random>
#include <utility>

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

TEST_CASE("No detour is shorter than a Dubins path") {
  std::mt19937 random(13);
  for (int round = 0; round < 3000; ++round) {
    const Task task = random_task(random);
    const Pose elsewhere = random_task(random).goal;
    const double length = DubinsPath(task.start, task.goal, task.radius_m).length_m();
    CAPTURE(round);
    REQUIRE(length >= apart(task.start.point, task.goal.point) * (1 - 1e-7));
    REQUIRE(DubinsPath(task.start, elsewhere, task.radius_m).length_m() +
                DubinsPath(elsewhere, task.goal, task.radius_m).length_m() >=
            length - 1e-6 * (task.radius_m + length));
  }
}

TEST_CASE("A pose for which another library gives up has a Dubins path") {
  const Pose start{{19577.925802642028, 12099.631851285438}, 1.8630325762127198};
  const Pose goal{{14344.902607243122, 29734.056912989599}, -2.6949846600427549};
  const DubinsPath path(start, goal, 60);
  CHECK(path.length_m() >= apart(start.point, goal.point));
  CHECK(path.length_m() <= apart(start.point, goal.point) + 4 * kPi * 60);
}

TEST_CASE("A Dubins path's waypoints lead from pose to pose, turn gently and keep to it") {
  std::mt19937 random(14);
  for (int round = 0; round < 3000; ++round) {
    const Task task = random_task(random);
    const DubinsPath path(task.start, task.goal, task.radius_m);
    const auto points = path.waypoints();
    // Shorter legs have any heading by rounding.
    const double shortest = 1e-6 * (task.radius_m + apart(task.start.point, task.goal.point));
    double length = 0;
    double heading = task.start.heading_rad;
    double sharpest = 0;
    bool begins = true;
    CAPTURE(round, task.radius_m);
    for (std::size_t i = 1; i < points.size(); ++i) {
      const double leg = apart(points[i - 1], points[i]);
      length += leg;
      if (leg < shortest) continue;
      const double next = std::atan2(points[i].east_m - points[i - 1].east_m,
                                     points[i].north_m - points[i - 1].north_m);
      if (std::exchange(begins, false)) REQUIRE(turned(heading, next) < 1e-3);
      sharpest = std::max(sharpest, turned(heading, next));
      heading = next;
    }
    REQUIRE(points.front() == task.start.point);
    REQUIRE(points.back() == task.goal.point);
    REQUIRE(turned(heading, task.goal.heading_rad) < 1e-3);
    REQUIRE(sharpest < 8 * kPi / 180 + 1e-3);
    // Tangents of 8 degrees are longer than their arc by less than a five-hundredth.
    REQUIRE(length >= path.length_m() * (1 - 1e-9) - 1e-9);
    REQUIRE(length <= path.length_m() * 1.002 + 1e-9);
  }
}

TEST_CASE("What no aircraft can fly is refused") {
  using skein::InvalidArgument;
  CHECK_THROWS_AS(DubinsPath({{0, 0}, 0}, {{1, 0}, 0}, 0), InvalidArgument);
  CHECK_THROWS_AS(DubinsPath({{0, 0}, 0}, {{1, NAN}, 0}, 10), InvalidArgument);
  CHECK_THROWS_AS(DubinsPath({{0, 0}, INFINITY}, {{1, 0}, 0}, 10), InvalidArgument);
}
