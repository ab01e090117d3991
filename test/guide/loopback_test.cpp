#include "skein/loopback.hpp"

#include <catch2/catch.hpp>

#include "skein/entity.hpp"
#include "skein/error.hpp"
#include "survey.idl.hpp"

using namespace std::chrono_literals;

namespace {

struct Planner : survey::INavigator {
  survey::Track plan(const survey::Area&) override { return {"Planner", 1000, 1000}; }
};

/// A drone and a station on a network whose time stands still.
struct Network {
  std::unique_ptr<skein::Entity> make_entity(const std::string& name) {
    return std::make_unique<skein::Entity>(
        skein::EntityOptions{.name = name,
                             .vendor = network.vendor(),
                             .process = std::make_shared<skein::Process>(clock)});
  }

  std::shared_ptr<skein::ManualClock> clock = std::make_shared<skein::ManualClock>();
  skein::dds::LoopbackNetwork network{*clock};
  std::unique_ptr<skein::Entity> drone = make_entity("drone");
  std::unique_ptr<skein::Entity> station = make_entity("station");
  skein::Guid provided = drone->provide<survey::INavigator>(std::make_shared<Planner>());
};

}  // namespace

TEST_CASE("a call whose answer is lost ends at its limit") {
  Network test;
  auto navigator = test.station->connect<survey::INavigator>();
  test.network.judge_transfers([](const skein::dds::Transfer& transfer) {
    return transfer.topic.ends_with("_Reply") ? skein::dds::Fate::drop()
                                              : skein::dds::Fate::deliver();
  });
  auto call = navigator.within(2s).async_plan({.length_m = 10, .width_m = 10});
  test.clock->advance(2s);  // at once
  CHECK_THROWS_AS(call.get(), skein::TimedOut);
}

TEST_CASE("a call to a drone that dies ends as soon as that is known") {
  Network test;
  auto navigator = test.station->connect<survey::INavigator>();
  test.network.judge_transfers([](const auto&) { return skein::dds::Fate::late(500ms); });
  auto call = navigator.within(10s).async_plan({.length_m = 10, .width_m = 10});
  test.network.kill(test.drone->guid());
  test.clock->advance(1500ms);
  CHECK_THROWS_AS(call.get(), skein::Disconnected);
}
