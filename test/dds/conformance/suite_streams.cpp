#include <algorithm>
#include <catch2/catch.hpp>

#include "wire.hpp"

using namespace skein;
using namespace skein::dds;
using namespace skein::dds::conformance;
using skein::test::eventually;
using namespace std::chrono_literals;

namespace {

Qos with_deadline(std::chrono::milliseconds deadline) {
  Qos qos = keep_all();
  qos.deadline = deadline;
  return qos;
}

Qos exclusive(std::int32_t strength = 0) {
  Qos qos = keep_all();
  qos.exclusive = true;
  qos.strength = strength;
  return qos;
}

bool holds(const std::vector<KeyHash>& keys, const KeyHash& key) {
  return std::find(keys.begin(), keys.end(), key) != keys.end();
}

/// Writes until the inbox has something from this writer.
bool heard_from(Outbox& outbox, Inbox& inbox, std::uint32_t number, const KeyHash& key) {
  return eventually([&] {
    outbox.writer().write(make_number(number), key);
    for (const Received& sample : inbox.received()) {
      if (sample.writer == outbox.writer().guid()) return true;
    }
    return false;
  });
}

}  // namespace

TEST_CASE_METHOD(Wire, "a missed deadline is told on both sides, of the instance that missed it") {
  Outbox outbox(*writing, keyed(), with_deadline(200ms));
  Inbox inbox(*reading, keyed(), with_deadline(300ms));
  REQUIRE(matched(outbox, inbox));
  REQUIRE(heard_from(outbox, inbox, 1, make_key(1)));
  REQUIRE(eventually([&] { return holds(outbox.missed_deadlines(), make_key(1)); }));
  REQUIRE(eventually([&] { return holds(inbox.missed_deadlines(), make_key(1)); }));
  CHECK_FALSE(holds(outbox.missed_deadlines(), make_key(2)));
  CHECK_FALSE(holds(inbox.missed_deadlines(), make_key(2)));
  // And again with each further period.
  const auto before = inbox.missed_deadlines().size();
  CHECK(eventually([&] { return inbox.missed_deadlines().size() > before; }));
}

TEST_CASE_METHOD(Wire, "a disposed instance misses no deadline") {
  Outbox outbox(*writing, keyed(), with_deadline(200ms));
  Inbox inbox(*reading, keyed(), with_deadline(200ms));
  REQUIRE(matched(outbox, inbox));
  REQUIRE(heard_from(outbox, inbox, 1, make_key(1)));
  REQUIRE(heard_from(outbox, inbox, 1, make_key(2)));
  outbox.writer().dispose(make_key(1));
  REQUIRE(eventually([&] { return inbox.received().back().state == InstanceState::Disposed; }));
  const auto count = [](const std::vector<KeyHash>& keys) {
    return std::count(keys.begin(), keys.end(), make_key(1));
  };
  const auto written = count(outbox.missed_deadlines());
  const auto read = count(inbox.missed_deadlines());
  const auto others = inbox.missed_deadlines().size();
  REQUIRE(eventually([&] { return inbox.missed_deadlines().size() >= others + 3; }));
  CHECK(count(outbox.missed_deadlines()) == written);
  CHECK(count(inbox.missed_deadlines()) == read);
}

TEST_CASE_METHOD(Wire, "a sample whose lifespan is over is not handed over, but counted") {
  Qos qos = keep_all();
  qos.lifespan = 200ms;
  Outbox outbox(*writing, keyless(), qos);
  const auto reader = reading->create_reader(keyless(), keep_all());
  Inbox witness(*reading, keyless(), keep_all());
  REQUIRE(connected(outbox, witness));
  REQUIRE(eventually([&] { return outbox.writer().matched_readers().size() == 2; }));
  // What connected() wrote, perhaps more than once, has arrived.
  REQUIRE(outbox.writer().wait_for_acknowledgments(10s));
  reader->take([](const Sample&) {});
  const auto before = reader->counters().expired;
  outbox.writer().write(make_number(7));
  REQUIRE(eventually([&] { return witness.count() == 1; }));
  REQUIRE(outbox.writer().wait_for_acknowledgments(10s));
  const auto written = std::chrono::steady_clock::now();
  REQUIRE(eventually([&] { return std::chrono::steady_clock::now() - written > 200ms; }));
  std::size_t taken = 0;
  reader->take([&](const Sample&) { ++taken; });
  CHECK(taken == 0);
  CHECK(reader->counters().expired == before + 1);
  CHECK(witness.reader().counters().expired == 0);
}

TEST_CASE_METHOD(Wire, "a late joiner is not given what has expired") {
  Qos qos = last_state();
  qos.lifespan = 300ms;
  Outbox outbox(*writing, keyed(), qos);
  outbox.writer().write(make_number(1), make_key(1));
  const auto written = std::chrono::steady_clock::now();
  REQUIRE(eventually([&] { return std::chrono::steady_clock::now() - written > 300ms; }));
  qos.lifespan = std::nullopt;
  Inbox late(*reading, keyed(), qos);
  REQUIRE(matched(outbox, late));
  outbox.writer().write(make_number(2), make_key(2));
  REQUIRE(eventually([&] { return late.count() > 0; }));
  CHECK(numbers(late.received()) == std::vector<std::uint32_t>{2});
}

TEST_CASE_METHOD(Wire,
                 "a reader with a limit keeps the newest samples, and counts those that gave way") {
  Qos qos = keep_all();
  qos.max_waiting = 3;
  Outbox outbox(*writing, keyless(), keep_all());
  const auto reader = reading->create_reader(keyless(), qos);
  Inbox witness(*reading, keyless(), keep_all());
  REQUIRE(connected(outbox, witness));
  REQUIRE(eventually([&] { return outbox.writer().matched_readers().size() == 2; }));
  REQUIRE(outbox.writer().wait_for_acknowledgments(10s));
  reader->take([](const Sample&) {});
  for (std::uint32_t i = 0; i < 10; ++i) outbox.writer().write(make_number(i));
  REQUIRE(eventually([&] { return witness.count() == 10; }));
  REQUIRE(eventually([&] { return reader->counters().replaced >= 7; }));
  std::vector<std::uint32_t> values;
  reader->take([&](const Sample& sample) {
    values.push_back(to_number({sample.cdr.begin(), sample.cdr.end()}));
  });
  CHECK(values == std::vector<std::uint32_t>{7, 8, 9});
}

TEST_CASE_METHOD(
    Wire,
    "of an exclusive instance only the strongest writer is heard, and the next when it goes") {
  Inbox inbox(*reading, keyed(), exclusive());
  Outbox weak(*writing, keyed(), exclusive(1));
  REQUIRE(matched(weak, inbox));
  REQUIRE(heard_from(weak, inbox, 1, make_key(1)));
  auto strong = std::make_unique<Outbox>(*writing, keyed(), exclusive(2));
  REQUIRE(matched(*strong, inbox));
  REQUIRE(heard_from(*strong, inbox, 2, make_key(1)));
  REQUIRE(strong->writer().wait_for_acknowledgments(10s));
  inbox.forget_samples();
  weak.writer().write(make_number(3), make_key(1));
  weak.writer().write(make_number(4), make_key(2));  // another instance, which it owns
  REQUIRE(eventually([&] { return inbox.count() > 0; }));
  CHECK(numbers(inbox.received()) == std::vector<std::uint32_t>{4});
  inbox.forget_samples();
  strong.reset();
  CHECK(heard_from(weak, inbox, 5, make_key(1)));
}

TEST_CASE_METHOD(Wire,
                 "the owner that misses a deadline loses the instance until it writes again") {
  Qos qos = exclusive();
  qos.deadline = 300ms;
  Inbox inbox(*reading, keyed(), qos);
  qos.strength = 1;
  Outbox weak(*writing, keyed(), qos);
  qos.strength = 2;
  Outbox strong(*writing, keyed(), qos);
  REQUIRE(matched(weak, inbox));
  REQUIRE(matched(strong, inbox));
  REQUIRE(heard_from(strong, inbox, 1, make_key(1)));
  CHECK(heard_from(weak, inbox, 2, make_key(1)));
  CHECK(eventually([&] { return holds(inbox.missed_deadlines(), make_key(1)); }));
  inbox.forget_samples();
  CHECK(heard_from(strong, inbox, 3, make_key(1)));
}

TEST_CASE("an incompatible offer is told on both sides with topic, policy, values and remedy") {
  struct Case {
    std::string policy;
    Qos offered;
    Qos requested;
    std::string says;
  };
  Qos best_effort = keep_all();
  best_effort.reliable = false;
  Qos leased = keep_all();
  leased.liveliness_lease = 500ms;
  const std::vector<Case> cases{
      {"reliability", best_effort, keep_all(), "offers best effort, the reader requests reliable"},
      {"durability", keep_all(), last_state(),
       "offers volatile, the reader requests transient-local"},
      {"deadline", with_deadline(200ms), with_deadline(100ms),
       "offers 200 ms, the reader requests 100 ms"},
      {"liveliness", keep_all(), leased, "offers none, the reader requests 500 ms"},
      {"ownership", exclusive(), keep_all(), "offers exclusive, the reader requests shared"}};
  Wire wire;
  for (const Case& each : cases) {
    INFO(each.policy);
    const Topic topic = keyed("stream_" + each.policy);
    Outbox outbox(*wire.writing, topic, each.offered);
    Inbox inbox(*wire.reading, topic, each.requested);
    REQUIRE(eventually(
        [&] { return !outbox.incompatible().empty() && !inbox.incompatible().empty(); }));
    CHECK(outbox.incompatible().front().peer == inbox.reader().guid());
    CHECK(inbox.incompatible().front().peer == outbox.writer().guid());
    for (const Incompatibility& why :
         {outbox.incompatible().front(), inbox.incompatible().front()}) {
      CHECK(why.policy == each.policy);
      CHECK_THAT(why.explanation,
                 Catch::Contains("'" + topic.name + "'") && Catch::Contains(each.says));
    }
    Outbox later(*wire.writing, topic, each.offered);
    CHECK(eventually([&] { return inbox.incompatible().size() == 2; }));
    CHECK(outbox.writer().matched_readers().empty());
  }
}

TEST_CASE_METHOD(Wire, "what is in another partition is not incompatible") {
  Qos elsewhere = keep_all();
  elsewhere.partitions = {"elsewhere"};
  elsewhere.reliable = false;
  Outbox outbox(*writing, keyless("one"), elsewhere);
  Inbox inbox(*reading, keyless("one"), keep_all());
  Outbox later(*writing, keyless("two"), keep_all());
  Inbox late(*reading, keyless("two"), keep_all());
  REQUIRE(matched(later, late));
  CHECK(outbox.incompatible().empty());
  CHECK(inbox.incompatible().empty());
}

TEST_CASE_METHOD(Wire, "qualities of a stream that mean nothing are refused") {
  Qos qos = keep_all();
  qos.strength = 3;
  CHECK_THROWS_WITH(writing->create_writer(keyless(), qos), Catch::Contains("exclusive"));
  CHECK_THROWS_AS(writing->create_writer(keyless(), with_deadline(0ms)), InvalidArgument);
  qos = keep_all();
  qos.lifespan = 0ms;
  CHECK_THROWS_AS(writing->create_writer(keyless(), qos), InvalidArgument);
}
