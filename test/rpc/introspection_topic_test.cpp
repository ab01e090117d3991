#include "rpc/introspection_topic.hpp"

#include <catch2/catch.hpp>
#include <future>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "../tools/log.hpp"
#include "skein/clock.hpp"
#include "skein/detail/codec.hpp"
#include "skein/introspection.idl.hpp"
#include "skein/loopback.hpp"

using namespace skein;
using namespace std::chrono_literals;
using introspection::CallEvent;
using introspection::kCalls;
using introspection::kStatistics;
using introspection::ServiceStatistics;
using skein::test::Log;

namespace {

/// Two peers on a network on which everything happens inside the call that causes it.
struct World {
  ManualClock clock;
  dds::LoopbackNetwork network{clock};
  std::unique_ptr<dds::Participant> near = network.vendor()->create_participant({});
  std::unique_ptr<dds::Participant> far = network.vendor()->create_participant({});
  ManualExecutor control;
};

/// Who reads what happens to calls, and what has come.
struct Onlooker {
  explicit Onlooker(dds::Participant& participant)
      : reader(participant, kCalls, [this](const CallEvent& event) { events.push_back(event); }) {}

  std::vector<CallEvent> events;
  introspection::Reader<CallEvent> reader;  // last: goes first
};

CallEvent event(std::uint64_t number) {
  CallEvent event;
  event.number = number;
  return event;
}

ServiceStatistics statistics(std::uint8_t provider) {
  ServiceStatistics statistics;
  statistics.provider.fill(provider);
  return statistics;
}

}  // namespace

TEST_CASE("a publisher writes only while somebody reads") {
  World world;
  introspection::Publisher<CallEvent> publisher(*world.near, world.control, kCalls);
  CHECK_FALSE(publisher.on());
  publisher.publish(event(1));
  CHECK(world.control.run_all() == 0);
  {
    Onlooker onlooker(*world.far);
    CHECK(publisher.on());
    publisher.publish(event(2));
    publisher.publish(event(3));
    CHECK(onlooker.events.empty());
    CHECK(world.control.run_all() == 1);
    REQUIRE(onlooker.events.size() == 2);
    CHECK(onlooker.events[0] == event(2));
    CHECK(onlooker.events[1] == event(3));
  }
  CHECK_FALSE(publisher.on());
  publisher.publish(event(4));
  CHECK(world.control.run_all() == 0);
}

TEST_CASE("a publisher is on until its last reader goes, and for those who were there before it") {
  World world;
  auto first = std::make_optional<Onlooker>(*world.far);
  introspection::Publisher<CallEvent> publisher(*world.near, world.control, kCalls);
  CHECK(publisher.on());
  auto second = std::make_optional<Onlooker>(*world.near);
  first.reset();
  CHECK(publisher.on());
  second.reset();
  CHECK_FALSE(publisher.on());
}

TEST_CASE("what finds no room at a publisher is dropped, and the values tell how many were") {
  World world;
  introspection::Publisher<CallEvent> publisher(*world.near, world.control, kCalls);
  Onlooker onlooker(*world.far);
  for (std::size_t i = 0; i < publisher.kCapacity + 10; ++i) publisher.publish(event(i));
  CHECK(world.control.run_all() == 1);
  REQUIRE(onlooker.events.size() == publisher.kCapacity);
  CHECK(onlooker.events.back().number == publisher.kCapacity - 1);
  CHECK(onlooker.events.back().dropped == 10);
  publisher.publish(event(0));
  CHECK(world.control.run_all() == 1);
  CHECK(onlooker.events.back().number == 0);
  CHECK(onlooker.events.back().dropped == 10);
}

TEST_CASE("a value that cannot be sent is logged, and the others are sent") {
  World world;
  introspection::Publisher<CallEvent> publisher(*world.near, world.control, kCalls);
  Onlooker onlooker(*world.far);
  const Log log;
  CallEvent unspeakable = event(1);
  unspeakable.operation = std::string("\0", 1);
  publisher.publish(unspeakable);
  publisher.publish(event(2));
  world.control.run_all();
  CHECK(log.count("skein/calls: a sample was not sent") == 1);
  REQUIRE(onlooker.events.size() == 1);
  CHECK(onlooker.events[0].number == 2);
}

TEST_CASE("who begins when somebody reads does so each time that somebody does after nobody did") {
  World world;
  introspection::Publisher<CallEvent> publisher(*world.near, world.control, kCalls);
  std::optional<Onlooker> first, second;
  int begun = 0;
  const auto begin = [&] { ++begun; };
  SECTION("a reader comes later") {
    publisher.when_read(begin);
    first.emplace(*world.far);
    CHECK(begun == 0);
  }
  SECTION("a reader is there already") {
    first.emplace(*world.far);
    publisher.when_read(begin);
    CHECK(begun == 0);
  }
  world.control.run_all();
  CHECK(begun == 1);
  second.emplace(*world.far);
  first.reset();
  CHECK(world.control.run_all() == 0);
  second.reset();
  first.emplace(*world.far);
  world.control.run_all();
  CHECK(begun == 2);
}

TEST_CASE("a closed publisher uses neither its participant nor its executor") {
  World world;
  auto control = std::make_unique<ManualExecutor>();
  introspection::Publisher<CallEvent> publisher(*world.near, *control, kCalls);
  bool ran = false;
  publisher.when_read([&] { ran = true; });
  Onlooker onlooker(*world.far);
  publisher.publish(event(1));
  publisher.post([&] { ran = true; });
  publisher.close();
  CHECK_FALSE(publisher.on());
  world.near.reset();
  CHECK(control->run_all() == 3);
  CHECK_FALSE(ran);
  control.reset();
  publisher.publish(event(2));
  publisher.post([&] { ran = true; });
  publisher.when_read([&] { ran = true; });
  publisher.close();
  CHECK(onlooker.events.empty());
}

TEST_CASE("tasks that a publisher has posted may outlive it") {
  World world;
  Onlooker onlooker(*world.far);
  {
    introspection::Publisher<CallEvent> publisher(*world.near, world.control, kCalls);
    publisher.publish(event(1));
  }
  CHECK(world.control.run_all() == 1);
  CHECK(onlooker.events.empty());
}

TEST_CASE("a publisher that closes waits for its task that runs") {
  World world;
  ThreadExecutor control("control");
  introspection::Publisher<CallEvent> publisher(*world.near, control, kCalls);
  std::promise<void> begun, end;
  bool ended = false;
  publisher.post([&] {
    begun.set_value();
    end.get_future().wait();
    ended = true;
  });
  begun.get_future().wait();
  auto closing = std::async(std::launch::async, [&] { publisher.close(); });
  // What does not wait has ended by then; what waits is not hurt by it.
  CHECK(closing.wait_for(50ms) == std::future_status::timeout);
  end.set_value();
  closing.get();
  CHECK(ended);
}

TEST_CASE("a reader refuses what is no value, or one of another key, and logs the first alone") {
  World world;
  std::vector<ServiceStatistics> taken;
  introspection::Reader<ServiceStatistics> reader(
      *world.far, kStatistics,
      [&](const ServiceStatistics& statistics) { taken.push_back(statistics); });
  const auto writer = world.near->create_writer(kStatistics.dds_topic(), kStatistics.qos());
  const Log log;
  const ServiceStatistics one = statistics(1);
  Bytes half = idl::encode_message(one);
  half.resize(half.size() / 2);
  writer->write(half, key_hash(one));
  CHECK(reader.refused() == 1);
  writer->write(idl::encode_message(one), key_hash(statistics(2)));
  CHECK(reader.refused() == 2);
  CHECK(taken.empty());
  CHECK(log.count("skein/statistics: dropped a sample of participant " +
                  world.near->guid().hex().substr(0, 24)) == 1);
  writer->write(idl::encode_message(one), key_hash(one));
  writer->dispose(key_hash(one));
  CHECK(reader.refused() == 2);
  REQUIRE(taken.size() == 1);
  CHECK(taken[0] == one);
}

TEST_CASE("a reader refuses what its consumer throws at") {
  World world;
  introspection::Publisher<CallEvent> publisher(*world.near, world.control, kCalls);
  const Log log;
  introspection::Reader<CallEvent> reader(
      *world.far, kCalls, [](const CallEvent&) { throw InvalidArgument("it is not believed"); });
  publisher.publish(event(1));
  publisher.publish(event(2));
  world.control.run_all();
  CHECK(reader.refused() == 2);
  CHECK(log.count("it is not believed") == 1);
}
