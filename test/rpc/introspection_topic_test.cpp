#include "rpc/service/introspection_topic.hpp"

#include <catch2/catch.hpp>
#include <future>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "rpc/service/batch_publisher.hpp"
#include "rpc/service/call_recorder.hpp"
#include "skein/clock.hpp"
#include "skein/detail/codec.hpp"
#include "skein/detail/type_support.hpp"
#include "skein/introspection.idl.hpp"
#include "skein/loopback.hpp"
#include "test/tools/log.hpp"

using namespace skein;
using namespace std::chrono_literals;
using introspection::CallRecord;
using introspection::CallRecords;
using introspection::Decision;
using introspection::ServiceStatistics;
using skein::test::Log;

namespace {

constexpr const auto& kCallRecords = introspection::kTopic<CallRecords>;
constexpr const auto& kDecisions = introspection::kTopic<Decision>;
constexpr const auto& kStatistics = introspection::kTopic<ServiceStatistics>;

/// Two peers on a network on which everything happens inside the call that causes it.
struct World {
  ManualClock clock;
  dds::LoopbackNetwork network{clock};
  std::unique_ptr<dds::Participant> near = network.vendor()->create_participant({});
  std::unique_ptr<dds::Participant> far = network.vendor()->create_participant({});
  ManualExecutor control;
};

/// Who reads one of these topics, and what has come.
template <class T>
struct Onlooker {
  Onlooker(dds::Participant& participant, const introspection::Topic<T>& topic)
      : reader(participant, topic, [this](const T& value) { values.push_back(value); }) {}

  std::vector<T> values;
  introspection::Reader<T> reader;  // last: goes first
};

using Observer = Onlooker<Decision>;

Decision decision(std::uint64_t number) {
  Decision decision;
  decision.number = number;
  return decision;
}

CallRecord record(std::uint64_t number, std::size_t size = 0) {
  CallRecord record;
  record.number = number;
  record.arguments.resize(size);
  return record;
}

using RecordPublisher = introspection::BatchPublisher<CallRecords>;

ServiceStatistics statistics(std::uint8_t provider) {
  ServiceStatistics statistics;
  statistics.provider.fill(provider);
  return statistics;
}

}  // namespace

TEST_CASE_METHOD(World,
                 "each topic is named for its type, and carries its values to who reads it") {
  std::set<std::string> names;
  introspection::for_each_topic([&]<class T>(const introspection::Topic<T>& topic) {
    CAPTURE(topic.name);
    CHECK(names.insert(topic.name).second);
    CHECK_THAT(topic.name, Catch::StartsWith("skein/"));
    CHECK(topic.type_name == idl::type_support<T>().name);
    CHECK(topic.keyed == requires(const T& value) { key_hash(value); });
    introspection::Publisher<T> publisher(*near, control, topic);
    const Onlooker<T> onlooker(*far, topic);
    publisher.publish(T{});
    control.run_all();
    CHECK(onlooker.values == std::vector{T{}});
  });
}

TEST_CASE_METHOD(World, "a publisher writes only while somebody reads") {
  introspection::Publisher<Decision> publisher(*near, control, kDecisions);
  CHECK_FALSE(publisher.on());
  publisher.publish(decision(1));
  CHECK(control.run_all() == 0);
  {
    Observer onlooker(*far, kDecisions);
    CHECK(publisher.on());
    publisher.publish(decision(2));
    publisher.publish(decision(3));
    CHECK(onlooker.values.empty());
    CHECK(control.run_all() == 2);
    REQUIRE(onlooker.values.size() == 2);
    CHECK(onlooker.values[0] == decision(2));
    CHECK(onlooker.values[1] == decision(3));
  }
  CHECK_FALSE(publisher.on());
  publisher.publish(decision(4));
  CHECK(control.run_all() == 0);
}

TEST_CASE_METHOD(
    World, "a publisher is on until its last reader goes, and for those who were there before it") {
  auto first = std::make_optional<Observer>(*far, kDecisions);
  introspection::Publisher<Decision> publisher(*near, control, kDecisions);
  CHECK(publisher.on());
  auto second = std::make_optional<Observer>(*near, kDecisions);
  first.reset();
  CHECK(publisher.on());
  second.reset();
  CHECK_FALSE(publisher.on());
}

TEST_CASE_METHOD(World, "what finds no room at a publisher is dropped") {
  introspection::Publisher<Decision> publisher(*near, control, kDecisions);
  Observer onlooker(*far, kDecisions);
  for (std::size_t i = 0; i < publisher.kCapacity + 10; ++i) publisher.publish(decision(i));
  control.run_all();
  REQUIRE(onlooker.values.size() == publisher.kCapacity);
  CHECK(onlooker.values.back().number == publisher.kCapacity - 1);
  publisher.publish(decision(0));
  control.run_all();
  CHECK(onlooker.values.back().number == 0);
}

TEST_CASE_METHOD(World, "a value that cannot be sent is logged, and the others are sent") {
  introspection::Publisher<Decision> publisher(*near, control, kDecisions);
  Observer onlooker(*far, kDecisions);
  const Log log;
  Decision unspeakable = decision(1);
  unspeakable.request = std::string("\0", 1);
  publisher.publish(unspeakable);
  publisher.publish(decision(2));
  control.run_all();
  CHECK(log.count("skein/decisions: a sample was not sent") == 1);
  REQUIRE(onlooker.values.size() == 1);
  CHECK(onlooker.values[0].number == 2);
}

TEST_CASE_METHOD(World,
                 "a task that is to run when somebody reads runs for each reader that comes") {
  introspection::Publisher<Decision> publisher(*near, control, kDecisions);
  std::optional<Observer> first, second;
  int begun = 0;
  const auto begin = [&] { ++begun; };
  SECTION("a reader comes later") {
    publisher.when_read(begin);
    first.emplace(*far, kDecisions);
    CHECK(begun == 0);
  }
  SECTION("a reader is there already") {
    first.emplace(*far, kDecisions);
    publisher.when_read(begin);
    CHECK(begun == 0);
  }
  control.run_all();
  CHECK(begun == 1);
  second.emplace(*far, kDecisions);
  first.reset();
  CHECK(control.run_all() == 1);
  second.reset();
  CHECK(control.run_all() == 0);
  first.emplace(*far, kDecisions);
  control.run_all();
  CHECK(begun == 3);
}

TEST_CASE_METHOD(World, "a closed publisher uses neither its participant nor its executor") {
  auto control = std::make_unique<ManualExecutor>();
  introspection::Publisher<Decision> publisher(*near, *control, kDecisions);
  bool ran = false;
  publisher.when_read([&] { ran = true; });
  Observer onlooker(*far, kDecisions);
  publisher.publish(decision(1));
  publisher.post([&] { ran = true; });
  publisher.close();
  CHECK_FALSE(publisher.on());
  near.reset();
  CHECK(control->run_all() == 3);
  CHECK_FALSE(ran);
  control.reset();
  publisher.publish(decision(2));
  publisher.post([&] { ran = true; });
  publisher.when_read([&] { ran = true; });
  publisher.close();
  CHECK(onlooker.values.empty());
}

TEST_CASE_METHOD(World, "tasks that a publisher has posted may outlive it") {
  Observer onlooker(*far, kDecisions);
  {
    introspection::Publisher<Decision> publisher(*near, control, kDecisions);
    publisher.publish(decision(1));
  }
  CHECK(control.run_all() == 1);
  CHECK(onlooker.values.empty());
}

TEST_CASE_METHOD(World, "a publisher that closes waits for its task that runs") {
  ThreadExecutor control("control");
  introspection::Publisher<Decision> publisher(*near, control, kDecisions);
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

TEST_CASE_METHOD(
    World, "a reader refuses what is no value, or one of another key, and logs the first alone") {
  std::vector<ServiceStatistics> taken;
  introspection::Reader<ServiceStatistics> reader(
      *far, kStatistics, [&](const ServiceStatistics& statistics) { taken.push_back(statistics); });
  const auto writer = near->create_writer(kStatistics.dds_topic(), kStatistics.qos());
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
                  near->guid().hex().substr(0, 24)) == 1);
  writer->write(idl::encode_message(one), key_hash(one));
  writer->dispose(key_hash(one));
  CHECK(reader.refused() == 2);
  REQUIRE(taken.size() == 1);
  CHECK(taken[0] == one);
}

TEST_CASE_METHOD(World, "a reader refuses what its consumer throws at") {
  introspection::Publisher<Decision> publisher(*near, control, kDecisions);
  const Log log;
  introspection::Reader<Decision> reader(
      *far, kDecisions, [](const Decision&) { throw InvalidArgument("it is not believed"); });
  publisher.publish(decision(1));
  publisher.publish(decision(2));
  control.run_all();
  CHECK(reader.refused() == 2);
  CHECK(log.count("it is not believed") == 1);
}

TEST_CASE_METHOD(World, "what is told of each call is gathered, and written as one sample") {
  RecordPublisher publisher(*near, clock, control, kCallRecords);
  publisher.publish(record(1));
  clock.advance(1s);
  CHECK(control.run_all() == 0);
  Onlooker<CallRecords> onlooker(*far, kCallRecords);
  publisher.publish(record(2));
  publisher.publish(record(3));
  CHECK(control.run_all() == 0);
  clock.advance(kCallRecords.interval);
  CHECK(control.run_all() == 1);
  REQUIRE(onlooker.values.size() == 1);
  CHECK(onlooker.values[0].values == std::vector{record(2), record(3)});
  CHECK(onlooker.values[0].dropped == 0);
  publisher.publish(record(4));
  clock.advance(kCallRecords.interval);
  CHECK(control.run_all() == 1);
  REQUIRE(onlooker.values.size() == 2);
  CHECK(onlooker.values[1].values == std::vector{record(4)});
}

TEST_CASE_METHOD(World, "large values are written in several samples, in their order") {
  RecordPublisher publisher(*near, clock, control, kCallRecords);
  Onlooker<CallRecords> onlooker(*far, kCallRecords);
  const std::size_t third = publisher.kMostInSample / 3;
  for (const auto& each : {record(1, third), record(2, third), record(3, third),
                           record(4, 10 * third), record(5), record(6)}) {
    publisher.publish(each);
  }
  clock.advance(kCallRecords.interval);
  control.run_all();
  std::vector<std::vector<std::uint64_t>> numbers;
  for (const CallRecords& batch : onlooker.values) {
    numbers.emplace_back();
    for (const CallRecord& each : batch.values) numbers.back().push_back(each.number);
  }
  CHECK(numbers == std::vector<std::vector<std::uint64_t>>{{1, 2}, {3}, {4}, {5, 6}});
}

TEST_CASE_METHOD(
    World, "gathered values for which there is no room are dropped, and samples tell how many") {
  RecordPublisher publisher(*near, clock, control, kCallRecords);
  Onlooker<CallRecords> onlooker(*far, kCallRecords);
  for (int i = 0; i < 5; ++i) publisher.publish(record(1, publisher.kMostWaiting / 3));
  publisher.publish(record(2));
  clock.advance(kCallRecords.interval);
  control.run_all();
  REQUIRE(onlooker.values.size() == 3);
  CHECK(onlooker.values.back().values == std::vector{record(2)});
  CHECK(onlooker.values.back().dropped == 3);
}

TEST_CASE_METHOD(World,
                 "a value that is larger than what may wait is written, where it waits alone") {
  RecordPublisher publisher(*near, clock, control, kCallRecords);
  Onlooker<CallRecords> onlooker(*far, kCallRecords);
  publisher.publish(record(1, publisher.kMostWaiting + 1));
  publisher.publish(record(2, publisher.kMostWaiting + 1));
  clock.advance(kCallRecords.interval);
  control.run_all();
  REQUIRE(onlooker.values.size() == 1);
  CHECK(onlooker.values[0].values.at(0).number == 1);
  CHECK(onlooker.values[0].dropped == 1);
}

TEST_CASE_METHOD(World,
                 "what was gathered is written when the publisher closes, and nothing after that") {
  Onlooker<CallRecords> onlooker(*far, kCallRecords);
  RecordPublisher publisher(*near, clock, control, kCallRecords);
  publisher.publish(record(1));
  publisher.close();
  REQUIRE(onlooker.values.size() == 1);
  CHECK(onlooker.values[0].values == std::vector{record(1)});
  publisher.publish(record(2));
  clock.advance(1s);
  CHECK(control.run_all() == 0);
  CHECK(onlooker.values.size() == 1);
}
