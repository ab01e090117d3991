#include <atomic>
#include <catch2/catch.hpp>
#include <memory>
#include <optional>
#include <stdexcept>
#include <thread>

#include "dds/port/port.hpp"
#include "skein/detail/codec.hpp"
#include "skein/entity.hpp"
#include "skein/error.hpp"
#include "skein/loopback.hpp"
#include "skein/topics.hpp"
#include "streams.idl.hpp"
#include "test/tools/eventually.hpp"
#include "test/tools/log.hpp"

using namespace skein;
using namespace std::chrono_literals;
using Catch::Contains;
using skein::test::eventually;
using skein::test::Log;
using streams::Depth;
using streams::Rudder;

namespace {

template <class T>
Publisher<T> publish(dds::Participant& participant, const std::string& topic,
                     const TopicQos& qos = {}) {
  return Publisher<T>(std::make_unique<topics::TopicWriter>(participant, topic,
                                                            topics::topic_type<T>(), qos, nullptr));
}

template <class T>
auto reader(dds::Participant& participant, Executor& executor, const std::string& topic,
            const TopicQos& qos, std::function<void(const T&)> callback,
            SubscriptionOptions options = {}) {
  return std::make_unique<topics::TopicReader>(
      participant, executor, topic, topics::topic_type<T>(), qos,
      topics::consumer_of(std::move(callback)), std::move(options), nullptr);
}

template <class T>
Subscription<T> subscribe(dds::Participant& participant, Executor& executor,
                          const std::string& topic, const TopicQos& qos,
                          std::function<void(const T&)> callback,
                          SubscriptionOptions options = {}) {
  return Subscription<T>(
      reader<T>(participant, executor, topic, qos, std::move(callback), std::move(options)));
}

/// Two participants on a network whose time stands still, and callbacks that run when the test says
/// so.
struct Sea {
  Publisher<Rudder> helm(const TopicQos& qos = {}) { return publish<Rudder>(*ship, "rudder", qos); }

  Subscription<Rudder> watch_rudder(const TopicQos& qos = {}, SubscriptionOptions options = {}) {
    const auto note = [this](const Rudder& value) { angles.push_back(value.angle_deg); };
    return subscribe<Rudder>(*shore, executor, "rudder", qos, note, std::move(options));
  }

  ManualClock clock;
  ManualExecutor executor;
  dds::LoopbackNetwork network{clock};
  std::unique_ptr<dds::Participant> ship = network.vendor()->create_participant({});
  std::unique_ptr<dds::Participant> shore = network.vendor()->create_participant({});
  std::vector<double> angles;
};

using Angles = std::vector<double>;

}  // namespace

TEST_CASE_METHOD(Sea,
                 "published values reach the callback in order, on the executor and nowhere else") {
  auto rudder = helm();
  const auto watch = watch_rudder();
  CHECK(rudder.subscribers() == 1);
  CHECK(watch.publishers() == 1);
  for (const double angle : {1.0, 2.0, 3.0}) rudder.publish({"helm", angle});
  CHECK(angles.empty());
  executor.run_all();
  CHECK(angles == Angles{1, 2, 3});
  CHECK(rudder.counters().published == 3);
  CHECK(watch.counters().received == 3);
}

TEST_CASE_METHOD(Sea, "a limit by which nothing could be published is refused") {
  TopicQos none;
  none.max_samples = 0;
  CHECK_THROWS_WITH(helm(none), Contains("topic 'rudder': `max_samples` is 0"));
  none.history_depth = 1;
  CHECK_NOTHROW(helm(none));
}

TEST_CASE_METHOD(Sea, "a long row of values is handed over whole, in several turns") {
  auto rudder = helm();
  const auto watch = watch_rudder();
  for (int i = 0; i < 500; ++i) rudder.publish({"helm", static_cast<double>(i)});
  CHECK(executor.run_all() > 2);
  REQUIRE(angles.size() == 500);
  CHECK(angles.back() == 499);
}

TEST_CASE_METHOD(Sea, "without a callback values wait until they are taken") {
  auto rudder = helm();
  auto watch = subscribe<Rudder>(*shore, executor, "rudder", {}, nullptr);
  CHECK_FALSE(watch.take());
  for (const double angle : {1.0, 2.0, 3.0}) rudder.publish({"helm", angle});
  CHECK(watch.take().value().angle_deg == 1);
  CHECK(watch.latest().value() == Rudder{"helm", 3});
  CHECK_FALSE(watch.latest());
  CHECK(watch.counters().received == 3);
}

TEST_CASE_METHOD(Sea, "who has a callback cannot take values, and is told so") {
  auto rudder = helm();
  auto watch = watch_rudder();
  rudder.publish({"helm", 1});
  CHECK_THROWS_AS(watch.take(), InvalidArgument);
  CHECK_THROWS_WITH(watch.latest(),
                    "topic 'rudder': a subscription with a callback has no values to take; they "
                    "go to the callback: subscribe without one, to poll");
  executor.run_all();
  CHECK(angles == Angles{1});
}

TEST_CASE_METHOD(Sea,
                 "of values that are too large to be sent best effort the publisher tells once") {
  const Log log;
  const std::string large((1 << 20) + 1, 'x');
  auto reliable = publish<Depth>(*ship, "depth");
  reliable.publish({1, 1, large});
  auto sensor = publish<Depth>(*ship, "depth", TopicQos::sensor());
  sensor.publish({1, 1, "small"});
  CHECK(log.text().empty());
  for (int i = 0; i < 3; ++i) sensor.publish({1, 1, large});
  CHECK(log.count("\n") == 1);
  CHECK(log.count("topic 'depth': a value of 1048") == 1);
  CHECK(log.count("published best effort") == 1);
}

TEST_CASE_METHOD(Sea,
                 "a slow subscriber loses its own oldest values, counted, and holds up nobody") {
  TopicQos qos;
  qos.max_waiting = 10;
  auto rudder = helm(qos);
  const auto slow = watch_rudder(qos);
  ManualExecutor prompt_executor;
  int prompt_values = 0;
  const auto prompt = subscribe<Rudder>(*shore, prompt_executor, "rudder", qos,
                                        [&](const Rudder&) { ++prompt_values; });
  for (int i = 0; i < 100; ++i) {
    rudder.publish({"helm", static_cast<double>(i)});
    prompt_executor.run_all();
  }
  CHECK(prompt_values == 100);
  CHECK(prompt.counters().dropped == 0);
  executor.run_all();
  CHECK(angles == Angles{90, 91, 92, 93, 94, 95, 96, 97, 98, 99});
  CHECK(slow.counters().dropped == 90);
  CHECK(slow.counters().received == 10);
}

TEST_CASE_METHOD(Sea,
                 "a sensor's subscriber finds the newest four values, and none that is too old") {
  auto rudder = helm(TopicQos::sensor(100ms));
  const auto watch = watch_rudder(TopicQos::sensor());
  for (int i = 1; i <= 6; ++i) {
    rudder.publish({"log", static_cast<double>(i)});
    clock.advance(30ms);
  }
  // 6 is 30 ms old, 5 is 60, 4 is 90, 3 is 120.
  executor.run_all();
  CHECK(angles == Angles{4, 5, 6});
  CHECK(watch.counters().dropped == 2);
  CHECK(watch.counters().expired == 1);
}

TEST_CASE_METHOD(
    Sea, "an entity's options may change what the code asks for: here, a late joiner is told") {
  EntityOptions options;
  options.name = "ship";
  options.vendor = network.vendor();
  options.adjust_topic = [](const std::string& topic, TopicQos& qos) {
    if (topic == "rudder") qos = TopicQos::state();
  };
  Entity ship(options);
  options.name = "shore";
  Entity shore(options);
  auto rudder = ship.publisher<Rudder>("rudder");
  auto depth = ship.publisher<Depth>("depth");
  rudder.publish({"helm", 3});
  depth.publish({});
  auto late = shore.subscription<Rudder>("rudder");
  auto too_late = shore.subscription<Depth>("depth");
  CHECK(eventually([&] { return late.latest() == Rudder{"helm", 3}; }));
  CHECK_FALSE(too_late.latest());
}

TEST_CASE_METHOD(
    Sea, "of two commands the stronger is heard, and the weaker again once the stronger is late") {
  const auto watch = watch_rudder(TopicQos::command(0, 50ms));
  auto autopilot = publish<Rudder>(*ship, "rudder", TopicQos::command(1, 50ms));
  auto other_ship = network.vendor()->create_participant({});
  auto skipper = publish<Rudder>(*other_ship, "rudder", TopicQos::command(2, 50ms));
  autopilot.publish({"autopilot", 1});
  skipper.publish({"skipper", 2});
  autopilot.publish({"autopilot", 3});
  executor.run_all();
  CHECK(angles == Angles{2});  // depth 1: 2 took the place of 1
  clock.advance(100ms);
  CHECK(skipper.counters().missed_deadlines == 1);
  CHECK(watch.counters().missed_deadlines == 1);
  autopilot.publish({"autopilot", 4});
  executor.run_all();
  skipper.publish({"skipper", 5});
  executor.run_all();
  CHECK(angles == Angles{2, 4, 5});
}

TEST_CASE_METHOD(Sea, "a missed deadline is told on the executor, with the key") {
  TopicQos qos;
  qos.deadline = 100ms;
  auto depths = publish<Depth>(*ship, "depth", qos);
  std::vector<Guid> missed;
  SubscriptionOptions options;
  options.on_deadline_missed = [&](const Guid& key) { missed.push_back(key); };
  const auto watch = subscribe<Depth>(
      *shore, executor, "depth", qos, [](const Depth&) {}, options);
  depths.publish({7, 12.5, ""});
  executor.run_all();
  clock.advance(100ms);
  CHECK(missed.empty());
  executor.run_all();
  CHECK(missed == std::vector{key_hash(Depth{7, 0, ""})});
  CHECK(watch.counters().missed_deadlines == 1);
}

TEST_CASE_METHOD(Sea,
                 "who comes late is given the last state of each key, but not what was disposed") {
  auto depths = publish<Depth>(*ship, "depth", TopicQos::state());
  for (const std::int32_t sensor : {1, 2, 3}) {
    depths.publish({sensor, 1, "old"});
    depths.publish({sensor, 2, "new"});
  }
  depths.dispose({2, 0, ""});
  std::vector<Depth> values;
  std::vector<Guid> disposed;
  SubscriptionOptions options;
  options.on_disposed = [&](const Guid& key) { disposed.push_back(key); };
  const auto late = subscribe<Depth>(
      *shore, executor, "depth", TopicQos::state(),
      [&](const Depth& value) { values.push_back(value); }, options);
  executor.run_all();
  CHECK(values == std::vector<Depth>{{1, 2, "new"}, {3, 2, "new"}});
  depths.dispose({3, 0, ""});
  executor.run_all();
  CHECK(disposed == std::vector{key_hash(Depth{3, 0, ""})});
  CHECK(depths.counters().published == 8);
}

TEST_CASE_METHOD(Sea,
                 "a sample that is no such value is counted, reported once, and stops nothing") {
  const Log log;
  const auto watch = watch_rudder();
  const auto writer = ship->create_writer({"rudder", "streams::Rudder", false}, {});
  const Bytes no_rudder = idl::encode_message(streams::Sail{{}});
  writer->write(no_rudder);
  writer->write(no_rudder);
  writer->write(idl::encode_message(Rudder{"helm", 5}));
  executor.run_all();
  CHECK(angles == Angles{5});
  CHECK(watch.counters().malformed == 2);
  CHECK(watch.counters().received == 1);
  CHECK(log.count("\n") == 1);
  CHECK_THAT(log.text(),
             Contains("'rudder'") && Contains("streams::Rudder") && Contains("same IDL"));
}

TEST_CASE_METHOD(
    Sea, "a callback that throws is reported once, whatever it throws, and the next value comes") {
  const Log log;
  auto rudder = helm();
  const bool standard = GENERATE(true, false);
  int calls = 0;
  const auto watch = subscribe<Rudder>(*shore, executor, "rudder", {}, [&](const Rudder&) {
    ++calls;
    if (standard) throw std::runtime_error("aground");
    throw 42;
  });
  for (const double angle : {1.0, 2.0, 3.0}) rudder.publish({"helm", angle});
  executor.run_all();
  rudder.publish({"helm", 4});
  executor.run_all();
  CHECK(calls == 4);
  CHECK(log.count("\n") == 1);
  CHECK_THAT(log.text(),
             Contains("'rudder'") &&
                 Contains(standard ? "aground" : "something that is no std::exception"));
}

TEST_CASE_METHOD(
    Sea, "what is told of keys may throw anything, too, and the executor's thread goes on") {
  const Log log;
  TopicQos qos;
  qos.deadline = 100ms;
  ThreadExecutor executor("topics");
  auto depths = publish<Depth>(*ship, "depth", qos);
  std::atomic<int> told = 0;
  SubscriptionOptions options;
  options.executor = &executor;
  options.on_deadline_missed = [&](const Guid&) {
    ++told;
    throw 42;
  };
  options.on_disposed = options.on_deadline_missed;
  const auto watch = subscribe<Depth>(
      *shore, this->executor, "depth", qos, [](const Depth&) { throw 42; }, options);
  depths.publish({7, 12.5, ""});
  clock.advance(100ms);
  CHECK(eventually([&] { return told == 1; }));
  depths.dispose({7, 0, ""});
  CHECK(eventually([&] { return told == 2; }));
  executor.stop();
  CHECK(log.count("\n") == 1);
}

TEST_CASE_METHOD(Sea, "no callback runs once the subscription has gone") {
  auto rudder = helm();
  {
    const auto watch = watch_rudder();
    rudder.publish({"helm", 1});
  }
  executor.run_all();
  CHECK(angles.empty());
  CHECK(rudder.subscribers() == 0);
}

TEST_CASE_METHOD(Sea,
                 "a callback that does not return is told once, when a further value has come") {
  const Log log;
  auto rudder = helm();
  ThreadExecutor executor("topics");
  std::atomic<bool> inside = false;
  std::atomic<bool> may_return = false;
  const auto watch = subscribe<Rudder>(*shore, executor, "rudder", {}, [&](const Rudder&) {
    inside = true;
    eventually([&] { return may_return.load(); });
  });
  rudder.publish({"helm", 1});
  REQUIRE(eventually([&] { return inside.load(); }));
  const auto told = [&] { return log.count("a callback has not returned"); };
  rudder.publish({"helm", 2});
  CHECK(told() == 0);
  CHECK(eventually([&] {
    rudder.publish({"helm", 3});
    return told() == 1;
  }));
  rudder.publish({"helm", 4});
  CHECK(told() == 1);
  may_return = true;
}

TEST_CASE_METHOD(
    Sea, "who ends a subscription whose callback does not return is told what it waits for") {
  const Log log;
  auto rudder = helm();
  ThreadExecutor executor("topics");
  std::atomic<bool> inside = false;
  std::atomic<bool> may_return = false;
  auto watch = std::make_unique<Subscription<Rudder>>(
      reader<Rudder>(*shore, executor, "rudder", TopicQos{}, [&](const Rudder&) {
        inside = true;
        eventually([&] { return may_return.load(); });
      }));
  rudder.publish({"helm", 1});
  REQUIRE(eventually([&] { return inside.load(); }));
  std::thread ends([&] { watch.reset(); });
  CHECK(eventually([&] {
    return log.count(
               "topic 'rudder': whoever ends its subscription waits for a callback that does "
               "not return") == 1;
  }));
  may_return = true;
  ends.join();
}

TEST_CASE_METHOD(
    Sea, "a callback may not destroy its own subscription: that is told, and it is the last") {
  const Log log;
  auto rudder = helm();
  int calls = 0;
  std::optional<Subscription<Rudder>> watch;
  watch.emplace(reader<Rudder>(*shore, executor, "rudder", TopicQos{}, [&](const Rudder&) {
    ++calls;
    watch.reset();
  }));
  for (const double angle : {1.0, 2.0, 3.0}) rudder.publish({"helm", angle});
  executor.run_all();
  CHECK(calls == 1);
  CHECK(rudder.subscribers() == 0);
  CHECK(log.count("topic 'rudder': a callback destroys its own subscription") == 1);
}

TEST_CASE_METHOD(Sea, "profiles that do not fit are named in the log of both sides") {
  const Log log;
  auto rudder = helm(TopicQos::sensor());
  const auto watch = watch_rudder(TopicQos::state());
  CHECK(rudder.subscribers() == 0);
  CHECK(log.count("\n") == 2);
  for (const char* part : {"'rudder'", "best effort", "reliable"}) {
    INFO(part);
    CHECK(log.count(part) >= 2);
  }
}

TEST_CASE_METHOD(Sea, "a topic belongs to its systems") {
  TopicQos own;
  own.systems = {"uav-1"};
  TopicQos other;
  other.systems = {"uav-2"};
  TopicQos both;
  both.systems = {"uav-1", "uav-2"};
  auto rudder = helm(own);
  const auto watch = watch_rudder(other);
  CHECK(rudder.subscribers() == 0);
  const auto station = watch_rudder(both);
  CHECK(rudder.subscribers() == 1);
}

TEST_CASE_METHOD(Sea, "a publisher or a subscription that was moved from says so") {
  const std::string told =
      "this publisher or subscription was moved from; use the object that it was moved to";
  auto rudder = helm();
  auto watch = watch_rudder();
  const auto take = [](auto& from) { return std::move(from); };
  const auto moved_rudder = take(rudder);
  const auto moved_watch = take(watch);
  CHECK_THROWS_WITH(rudder.publish({"helm", 1}), told);
  CHECK_THROWS_WITH(rudder.subscribers(), told);
  CHECK_THROWS_WITH(watch.take(), told);
  CHECK(moved_rudder.subscribers() == 1);
  CHECK(moved_watch.publishers() == 1);
}

TEST_CASE_METHOD(Sea, "times that no clock counts are waited for, or refused as a topic's") {
  CHECK(helm().wait_for_acknowledgments(std::chrono::milliseconds::max()));
  const auto refused = [&](void (*change)(TopicQos&)) {
    TopicQos qos;
    change(qos);
    CHECK_THROWS_WITH(helm(qos), Contains("is longer than 50 years; write less"));
  };
  refused([](TopicQos& qos) { qos.max_blocking = std::chrono::milliseconds::max(); });
  refused([](TopicQos& qos) { qos.deadline = std::chrono::milliseconds::max(); });
  refused([](TopicQos& qos) { qos.lifespan = std::chrono::milliseconds::max(); });
  refused([](TopicQos& qos) { qos.liveliness_lease = std::chrono::milliseconds::max(); });
  dds::ParticipantOptions options;
  options.lease = std::chrono::milliseconds::max();
  CHECK_THROWS_WITH(network.vendor()->create_participant(options),
                    Contains("a participant's lease") && Contains("is longer than 50 years"));
}
