#include <catch2/catch.hpp>

#include "talk.hpp"

using namespace skein;
using namespace skein::dds;
using namespace skein::dds::conformance;
using skein::test::eventually;
using namespace std::chrono_literals;
using Catch::Contains;

TEST_CASE_METHOD(Matched,
                 "a sample in another encoding is counted and dropped, the next one arrives") {
  auto parameter_list = make_number(1);
  parameter_list[1] = std::byte{0x03};
  auto xcdr2 = make_number(2);
  xcdr2[1] = std::byte{0x07};
  auto nonsense = make_number(3);
  nonsense[0] = std::byte{0xFF};
  outbox.writer().write(parameter_list);
  outbox.writer().write(xcdr2);
  outbox.writer().write(nonsense);
  outbox.writer().write(make_number(4));
  REQUIRE(eventually([&] { return inbox.count() == 1; }));
  CHECK(numbers(inbox.received()) == std::vector<std::uint32_t>{4});
  CHECK(inbox.reader().counters().malformed == 3);
}

TEST_CASE_METHOD(Wire, "a sample without room for its header is refused by the writer") {
  const auto writer = writing->create_writer(keyless(), keep_all());
  const std::vector<std::byte> three(3);
  CHECK_THROWS_AS(writer->write(three), InvalidArgument);
  CHECK_THROWS_AS(writer->write({}), InvalidArgument);
}

TEST_CASE("a domain beyond the last one is refused") {
  ParticipantOptions options;
  options.domain = 233;
  CHECK_THROWS_WITH(load_vendor(kPairing.writing)->create_participant(options),
                    Contains("233") && Contains("232"));
}

TEST_CASE("other hosts cannot be looked for without an interface") {
  ParticipantOptions with_peers;
  with_peers.network.peers = {"10.0.0.2"};
  CHECK_THROWS_WITH(load_vendor(kPairing.writing)->create_participant(with_peers),
                    Contains("network.peers") && Contains("interfaces is empty"));
  ParticipantOptions with_multicast;
  with_multicast.network.multicast_discovery = true;
  CHECK_THROWS_WITH(load_vendor(kPairing.writing)->create_participant(with_multicast),
                    Contains("network.multicast_discovery") && Contains("interfaces is empty"));
}

TEST_CASE("an unknown interface is refused with the known ones") {
  ParticipantOptions options;
  options.network.interfaces = {"lo0"};
  CHECK_THROWS_WITH(load_vendor(kPairing.writing)->create_participant(options),
                    Contains("lo0") && Contains("did you mean 'lo'") && Contains("127.0.0.1"));
  options.network.interfaces = {"192.0.2.77"};  // which may still come
  CHECK_THROWS_AS(load_vendor(kPairing.writing)->create_participant(options), Unavailable);
}

TEST_CASE("a peer that is no host's name is refused") {
  ParticipantOptions options;
  options.network.peers = {"\"/><Tracing/>"};
  CHECK_THROWS_AS(load_vendor(kPairing.writing)->create_participant(options), InvalidArgument);
}

TEST_CASE_METHOD(Wire, "names and settings that a vendor could not honour are refused by all") {
  CHECK_THROWS_WITH(writing->create_writer({"a:b", "T", false}, keep_all()), Contains("a:b"));
  CHECK_THROWS_AS(writing->create_writer({"7up", "T", false}, keep_all()), InvalidArgument);
  CHECK_THROWS_AS(writing->create_writer({"", "T", false}, keep_all()), InvalidArgument);
  CHECK_THROWS_AS(writing->create_writer({"t", "", false}, keep_all()), InvalidArgument);
  Qos qos;
  qos.partitions = {"unit_*"};
  CHECK_THROWS_WITH(writing->create_reader(keyless(), qos), Contains("unit_*"));
  for (const std::size_t size : {256u, 65'600u}) {
    const std::string name(size, 'a');
    const Qos in_long_partition = [&] {
      Qos result;
      result.partitions = {name};
      return result;
    }();
    CHECK_THROWS_AS(writing->create_reader({name, "T", false}, {}), InvalidArgument);
    CHECK_THROWS_AS(writing->create_writer({"t", name, false}, {}), InvalidArgument);
    CHECK_THROWS_AS(writing->create_writer(keyless(), in_long_partition), InvalidArgument);
  }
  CHECK_THROWS_AS(writing->create_writer({"t", "T\n", false}, {}), InvalidArgument);
  const std::string longest(255, 'a');
  qos.partitions = {longest};
  CHECK_NOTHROW(writing->create_writer({longest, longest, false}, qos));
  qos = {};
  qos.history_depth = 0;
  CHECK_THROWS_AS(writing->create_reader(keyless(), qos), InvalidArgument);
}

TEST_CASE_METHOD(
    Wire, "a bounded writer is not held up by readers that acknowledge nothing by contract") {
  Qos bounded = keep_all();
  bounded.max_samples = 4;
  bounded.max_blocking = 2s;
  Qos best_effort;
  best_effort.reliable = false;
  Outbox outbox(*writing, keyless(), bounded);
  Inbox inbox(*reading, keyless(), best_effort);
  REQUIRE(matched(outbox, inbox));
  for (std::uint32_t i = 0; i < 100; ++i) REQUIRE_NOTHROW(outbox.writer().write(make_number(i)));
}

TEST_CASE_METHOD(Wire, "a bounded writer goes on as its readers acknowledge") {
  Qos bounded = keep_all();
  bounded.max_samples = 4;
  bounded.max_blocking = 10s;
  Outbox outbox(*writing, keyless(), bounded);
  Inbox inbox(*reading, keyless(), keep_all());
  REQUIRE(matched(outbox, inbox));
  for (std::uint32_t i = 0; i < 40; ++i) REQUIRE_NOTHROW(outbox.writer().write(make_number(i)));
  CHECK(eventually([&] { return inbox.count() == 40; }));
}

TEST_CASE_METHOD(
    Wire, "a bounded writer waits only for room, not for the acknowledgment of its last samples") {
  Qos bounded = keep_all();
  bounded.max_samples = 4;
  bounded.max_blocking = 0ms;
  Outbox outbox(*writing, keyless(), bounded);
  Inbox inbox(*reading, keyless(), keep_all());
  REQUIRE(matched(outbox, inbox));
  for (std::uint32_t i = 0; i < 40; ++i) {
    REQUIRE_NOTHROW(outbox.writer().write(make_number(i)));
    // Two at most have not been acknowledged when the next is written.
    if (i % 3 == 2) REQUIRE(outbox.writer().wait_for_acknowledgments(10s));
  }
  CHECK(eventually([&] { return inbox.count() == 40; }));
}

TEST_CASE_METHOD(Wire,
                 "a bounded writer that never pauses finds room when its reader has all it wrote") {
  Qos bounded = keep_all();
  bounded.max_samples = 128;
  // Less than a writer is silent before it asks by itself.
  bounded.max_blocking = 10ms;
  Outbox outbox(*writing, keyless(), bounded);
  Inbox inbox(*reading, keyless(), keep_all());
  REQUIRE(connected(outbox, inbox));
  for (std::uint32_t i = 0; i < 500; ++i) {
    REQUIRE_NOTHROW(outbox.writer().write(make_number(i)));
    REQUIRE(eventually([&] { return inbox.count() > i; }));
  }
}

TEST_CASE_METHOD(Wire, "a bounded writer without readers never waits") {
  Qos bounded = keep_all();
  bounded.max_samples = 2;
  Outbox outbox(*writing, keyless(), bounded);
  for (std::uint32_t i = 0; i < 20; ++i) REQUIRE_NOTHROW(outbox.writer().write(make_number(i)));
  CHECK(outbox.writer().wait_for_acknowledgments(1s));
}
