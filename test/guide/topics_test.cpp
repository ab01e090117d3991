#include <atomic>
#include <catch2/catch.hpp>
#include <optional>

#include "site.hpp"
#include "test/tools/eventually.hpp"

using namespace std::chrono_literals;
using skein::test::eventually;

TEST_CASE("each value of a sensor reaches a callback") {
  Site site;
  skein::Entity& drone = site.drone;
  skein::Entity& station = site.station;
  std::atomic<double> north_m{0};
  const auto show = [&](const survey::Pose& pose) { north_m = pose.north_m; };

  const auto chart = station.subscription<survey::Pose>(
      "pose", skein::TopicQos::sensor(), [&](const survey::Pose& pose) { show(pose); });

  auto poses = drone.publisher<survey::Pose>("pose", skein::TopicQos::sensor());
  poses.publish({"drone", 12.0, -3.5});

  // Best effort: one value may be lost.
  CHECK(eventually([&] {
    poses.publish({"drone", 12.0, -3.5});
    return north_m == 12;
  }));
  CHECK(chart.counters().malformed == 0);
}

TEST_CASE("a subscription can be kept where there is none yet") {
  Site site;
  skein::Entity& station = site.station;
  std::atomic<double> north_m{0};
  const auto show = [&](const survey::Pose& pose) { north_m = pose.north_m; };

  std::optional<skein::Subscription<survey::Pose>> chart;
  chart = station.subscription<survey::Pose>("pose", skein::TopicQos::sensor(), show);

  auto poses = site.drone.publisher<survey::Pose>("pose", skein::TopicQos::sensor());
  CHECK(eventually([&] {
    poses.publish({"drone", 14.0, -3.5});
    return north_m == 14;
  }));
}

TEST_CASE("the newest value can be polled") {
  Site site;
  skein::Entity& station = site.station;
  double north_m = 0;
  const auto show = [&](const survey::Pose& pose) { north_m = pose.north_m; };
  auto poses = site.drone.publisher<survey::Pose>("pose", skein::TopicQos::sensor());

  auto newest = station.subscription<survey::Pose>("pose", skein::TopicQos::sensor());
  if (const auto pose = newest.latest()) show(*pose);
  CHECK(north_m == 0);

  CHECK(eventually([&] {
    poses.publish({"drone", 13.0, -3.5});
    if (const auto pose = newest.latest()) show(*pose);
    return north_m == 13;
  }));
}

TEST_CASE("a state is told to those who come late, until it is disposed") {
  Site site;
  skein::Entity& drone = site.drone;
  skein::Entity& station = site.station;

  auto bases = drone.publisher<survey::Pose>("base", skein::TopicQos::state());
  bases.publish({"drone", 0, 0});

  auto late = station.subscription<survey::Pose>("base", skein::TopicQos::state());
  std::optional<survey::Pose> base;
  REQUIRE(eventually([&] {
    base = late.take();
    return base.has_value();
  }));
  CHECK(base->vehicle == "drone");

  bases.dispose({"drone", 0, 0});  // this vehicle's instance has ended

  skein::TopicQos qos = skein::TopicQos::command(2, 50ms);
  qos.systems = {"uav-1", "uav-2"};  // instead of the entity's own
  auto commands = station.publisher<survey::Pose>("goal", qos);

  commands.publish({"drone", 100, 0});
  CHECK(commands.counters().published == 1);
}
