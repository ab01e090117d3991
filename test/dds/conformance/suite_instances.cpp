#include <catch2/catch.hpp>
#include <map>

#include "talk.hpp"

using namespace skein;
using namespace skein::dds;
using namespace skein::dds::conformance;
using skein::test::eventually;
using namespace std::chrono_literals;

TEST_CASE_METHOD(MatchedKeyed, "each sample of a keyed topic comes with its key") {
  for (std::uint8_t i = 0; i < 10; ++i) {
    outbox.writer().write(make_sample(100 + i, i), make_key(i % 3));
  }
  REQUIRE(eventually([&] { return inbox.count() == 10; }));
  const auto received = inbox.received();
  for (std::uint8_t i = 0; i < 10; ++i) {
    CHECK(received[i].key == make_key(i % 3));
    CHECK((received[i].cdr == make_sample(100 + i, i)));
  }
}

TEST_CASE_METHOD(MatchedKeyed, "a large keyed sample keeps its key") {
  outbox.writer().write(make_sample(300'001), make_key(9));
  REQUIRE(eventually([&] { return inbox.count() == 1; }));
  CHECK(inbox.received()[0].key == make_key(9));
  CHECK(inbox.received()[0].cdr.size() == 300'001);
}

TEST_CASE_METHOD(MatchedKeyed,
                 "a disposal arrives with the right key, after what was written before") {
  outbox.writer().write(make_number(1), make_key(1));
  outbox.writer().write(make_number(2), make_key(2));
  outbox.writer().dispose(make_key(1));
  outbox.writer().write(make_number(3), make_key(2));
  REQUIRE(eventually([&] { return inbox.count() == 4; }));
  const auto received = inbox.received();
  CHECK(received[2].state == InstanceState::Disposed);
  CHECK(received[2].key == make_key(1));
  CHECK(received[2].cdr.empty());
  CHECK(received[2].writer == outbox.writer().guid());
  CHECK(received[3].state == InstanceState::Alive);
  CHECK(inbox.reader().counters().malformed == 0);
}

TEST_CASE_METHOD(MatchedState, "a disposed instance can be written again") {
  for (std::uint32_t round = 0; round < 3; ++round) {
    outbox.writer().write(make_number(round), make_key(1));
    REQUIRE(eventually([&] { return inbox.count() == 2 * round + 1; }));
    outbox.writer().dispose(make_key(1));
    REQUIRE(eventually([&] { return inbox.count() == 2 * round + 2; }));
  }
  CHECK(inbox.received()[4].state == InstanceState::Alive);
  CHECK(inbox.received()[5].state == InstanceState::Disposed);
}

TEST_CASE_METHOD(MatchedState, "a disposal just before the writer goes still arrives") {
  outbox.writer().write(make_number(1), make_key(1));
  REQUIRE(eventually([&] { return inbox.count() == 1; }));
  outbox.writer().dispose(make_key(1));
  outbox.writer().wait_for_acknowledgments(5s);
  outbox.close();
  REQUIRE(eventually([&] { return inbox.count() == 2; }));
  CHECK(inbox.received()[1].state == InstanceState::Disposed);
  CHECK(inbox.received()[1].key == make_key(1));
}

TEST_CASE_METHOD(MatchedState, "a writer that goes disposes nothing") {
  outbox.writer().write(make_number(1), make_key(1));
  REQUIRE(eventually([&] { return inbox.count() == 1; }));
  outbox.close();
  REQUIRE(eventually([&] { return inbox.matches().size() == 2; }));
  Outbox next(*writing, keyed(), last_state());
  REQUIRE(matched(next, inbox));
  next.writer().write(make_number(2), make_key(2));
  REQUIRE(eventually([&] { return inbox.count() >= 2; }));
  CHECK(inbox.received()[1].state == InstanceState::Alive);
  CHECK(inbox.received()[1].key == make_key(2));
}

TEST_CASE_METHOD(Wire, "only keyed topics can be disposed") {
  const auto writer = writing->create_writer(keyless(), keep_all());
  CHECK_THROWS_AS(writer->dispose(make_key(1)), InvalidArgument);
}

TEST_CASE_METHOD(Wire, "a late joiner gets the last sample of each instance, once") {
  Outbox outbox(*writing, keyed(), last_state());
  for (std::uint32_t round = 0; round < 3; ++round) {
    for (std::uint8_t key = 0; key < 50; ++key) {
      outbox.writer().write(make_number(round * 100 + key), make_key(key));
    }
  }
  Inbox inbox(*reading, keyed(), last_state());
  REQUIRE(matched(outbox, inbox));
  outbox.writer().write(make_number(1000), make_key(50));
  REQUIRE(eventually([&] { return inbox.count() >= 51; }));
  std::map<KeyHash, std::vector<std::uint32_t>> got;
  for (const Received& sample : inbox.received()) got[sample.key].push_back(to_number(sample.cdr));
  CHECK(inbox.count() == 51);
  for (std::uint8_t key = 0; key < 50; ++key) {
    CHECK(got[make_key(key)] == std::vector<std::uint32_t>{200u + key});
  }
}

TEST_CASE_METHOD(Wire, "a late joiner gets nothing of a volatile writer's past") {
  Outbox outbox(*writing, keyed(), keep_all());
  outbox.writer().write(make_number(1), make_key(1));
  Inbox inbox(*reading, keyed(), keep_all());
  REQUIRE(matched(outbox, inbox));
  REQUIRE(eventually([&] {
    outbox.writer().write(make_number(2), make_key(1));
    return inbox.count() > 0;
  }));
  CHECK(inbox.received()[0].key == make_key(1));
  CHECK(to_number(inbox.received()[0].cdr) == 2);
}

// Whether it is also sent the writer's past is not promised: Cyclone sends it to Fast DDS.
TEST_CASE_METHOD(Wire, "a volatile reader of a transient-local writer gets what comes after it") {
  Qos present = last_state();
  present.transient_local = false;
  Outbox outbox(*writing, keyed(), last_state());
  outbox.writer().write(make_number(1), make_key(1));
  Inbox inbox(*reading, keyed(), present);
  REQUIRE(matched(outbox, inbox));
  REQUIRE(eventually([&] {
    outbox.writer().write(make_number(2), make_key(2));
    const auto received = inbox.received();
    return !received.empty() && received.back().key == make_key(2);
  }));
}

TEST_CASE_METHOD(Wire, "a disposed instance is no news to a late joiner, or told as disposed") {
  Outbox outbox(*writing, keyed(), last_state());
  outbox.writer().write(make_number(1), make_key(1));
  outbox.writer().write(make_number(2), make_key(2));
  outbox.writer().dispose(make_key(1));
  Inbox inbox(*reading, keyed(), last_state());
  REQUIRE(eventually([&] {
    const auto received = inbox.received();
    return std::any_of(received.begin(), received.end(),
                       [](const Received& sample) { return sample.key == make_key(2); });
  }));
  for (const Received& sample : inbox.received()) {
    if (sample.key == make_key(1)) CHECK(sample.state == InstanceState::Disposed);
  }
}
