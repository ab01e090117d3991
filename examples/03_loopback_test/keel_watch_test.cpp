// Tests a client of a service without DDS, without waiting: the network is in the process, and time
// is invented.
#define CATCH_CONFIG_MAIN
#include "keel_watch.hpp"

#include <catch2/catch.hpp>

#include "skein/entity.hpp"
#include "skein/loopback.hpp"

using namespace std::chrono_literals;

namespace {

struct Sounder : diving::ISounder {
  double depth_m() override {
    if (depth > 100) throw diving::NoBottom(100);
    return depth;
  }
  std::atomic<double> depth = 10;
};

/// A boat with its keel watch, and a sounder that is a peer of its own.
struct Boat {
  std::unique_ptr<skein::Entity> make_entity(const std::string& name) {
    return std::make_unique<skein::Entity>(
        skein::EntityOptions{.name = name,
                             .vendor = network.vendor(),
                             .process = std::make_shared<skein::Process>(clock)});
  }

  std::shared_ptr<skein::ManualClock> clock = std::make_shared<skein::ManualClock>();
  skein::dds::LoopbackNetwork network{*clock};
  std::shared_ptr<Sounder> sounder = std::make_shared<Sounder>();
  std::unique_ptr<skein::Entity> mast = make_entity("mast");
  std::unique_ptr<skein::Entity> bridge = make_entity("bridge");
  skein::Guid provided = mast->provide<diving::ISounder>(sounder);
  KeelWatch watch{bridge->connect<diving::ISounder>()};
};

}  // namespace

TEST_CASE("in deep water the boat goes fast, in shallow water slowly") {
  Boat boat;
  CHECK(boat.watch.speed_m_s(boat.watch.ask()) == 5.0);
  boat.sounder->depth = 2;
  CHECK(boat.watch.speed_m_s(boat.watch.ask()) == 1.0);
}

TEST_CASE("no bottom is good news") {
  Boat boat;
  boat.sounder->depth = 4000;
  CHECK(boat.watch.speed_m_s(boat.watch.ask()) == 5.0);
}

TEST_CASE(
    "the boat stops where the sounder's answers are lost, after two seconds of which none passes") {
  Boat boat;
  boat.network.judge_transfers([](const skein::dds::Transfer& transfer) {
    return transfer.topic.ends_with("_Reply") ? skein::dds::Fate::drop()
                                              : skein::dds::Fate::deliver();
  });
  auto answer = boat.watch.ask();
  boat.clock->advance(1999ms);
  CHECK_FALSE(answer.ready());
  boat.clock->advance(1ms);
  CHECK(boat.watch.speed_m_s(std::move(answer)) == 0.0);
}

TEST_CASE("the boat stops where the sounder has died") {
  Boat boat;
  boat.network.judge_transfers([](const auto&) { return skein::dds::Fate::late(500ms); });
  auto answer = boat.watch.ask();
  boat.network.kill(boat.mast->guid());
  boat.clock->advance(1500ms);
  CHECK(boat.watch.speed_m_s(std::move(answer)) == 0.0);
}
