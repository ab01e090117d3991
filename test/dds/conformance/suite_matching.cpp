#include <catch2/catch.hpp>

#include "talk.hpp"

using namespace skein;
using namespace skein::dds;
using namespace skein::dds::conformance;
using skein::test::eventually;
using namespace std::chrono_literals;

using Events = std::vector<std::pair<Guid, bool>>;

TEST_CASE_METHOD(Matched, "both sides call an endpoint by the same GUID") {
  const Guid writer = outbox.writer().guid();
  const Guid reader = inbox.reader().guid();
  CHECK(writer.participant() == writing->guid());
  CHECK(reader.participant() == reading->guid());
  CHECK(writer != reader);
  REQUIRE(eventually([&] { return !outbox.matches().empty() && !inbox.matches().empty(); }));
  CHECK(outbox.matches() == Events{{reader, true}});
  CHECK(inbox.matches() == Events{{writer, true}});
}

TEST_CASE_METHOD(Matched, "a writer that goes is told to its readers") {
  const Guid writer = outbox.writer().guid();
  outbox.close();
  REQUIRE(eventually([&] { return inbox.matches().size() == 2; }));
  CHECK(inbox.matches() == Events{{writer, true}, {writer, false}});
  CHECK(inbox.reader().matched_writers().empty());
}

TEST_CASE_METHOD(Matched, "a reader that goes is told to its writers") {
  const Guid reader = inbox.reader().guid();
  inbox.close();
  REQUIRE(eventually([&] { return outbox.matches().size() == 2; }));
  CHECK(outbox.matches() == Events{{reader, true}, {reader, false}});
  CHECK(outbox.writer().matched_readers().empty());
}

TEST_CASE_METHOD(Wire, "endpoints that come later match too, on either side") {
  Outbox early(*writing, keyless("one"), keep_all());
  Inbox early_inbox(*reading, keyless("one"), keep_all());
  REQUIRE(matched(early, early_inbox));
  Inbox waiting(*reading, keyless("two"), keep_all());
  Outbox late(*writing, keyless("two"), keep_all());
  CHECK(matched(late, waiting));
  Outbox another(*writing, keyless("two"), keep_all());
  CHECK(matched(another, waiting));
}

TEST_CASE_METHOD(Wire, "a partition is matched exactly") {
  const std::string id = "0123456789abcdef0123456789abcdef";
  Qos own = keep_all();
  own.partitions = {id};
  Qos server = keep_all();
  server.partitions = {"", id};
  Qos neighbour = keep_all();
  neighbour.partitions = {"0123456789abcdef0123456789abcdee"};
  Qos upper = keep_all();
  upper.partitions = {"0123456789ABCDEF0123456789ABCDEF"};

  Inbox to_server(*reading, keyless(), server);
  Inbox to_neighbour(*reading, keyless(), neighbour);
  Inbox to_upper(*reading, keyless(), upper);
  Inbox to_all(*reading, keyless(), keep_all());
  Outbox direct(*writing, keyless(), own);
  Outbox broadcast(*writing, keyless(), keep_all());
  REQUIRE(matched(direct, to_server));
  REQUIRE(matched(broadcast, to_server));
  REQUIRE(matched(broadcast, to_all));

  direct.writer().write(make_number(1));
  broadcast.writer().write(make_number(2));
  REQUIRE(eventually([&] { return to_server.count() == 2; }));
  REQUIRE(eventually([&] { return to_all.count() == 1; }));
  CHECK(numbers(to_all.received()) == std::vector<std::uint32_t>{2});
  CHECK(direct.writer().matched_readers() == std::vector{to_server.reader().guid()});
  CHECK(to_neighbour.reader().matched_writers().empty());
  CHECK(to_upper.reader().matched_writers().empty());
  CHECK(to_neighbour.count() == 0);
  CHECK(to_upper.count() == 0);
}

TEST_CASE_METHOD(Wire, "no partition and the partition with the empty name are the same") {
  Qos named = keep_all();
  named.partitions = {""};
  Outbox outbox(*writing, keyless("a"), named);
  Inbox inbox(*reading, keyless("a"), keep_all());
  CHECK(matched(outbox, inbox));
  Outbox plain(*writing, keyless("b"), keep_all());
  Inbox named_inbox(*reading, keyless("b"), named);
  CHECK(matched(plain, named_inbox));
}

TEST_CASE_METHOD(Wire, "another type of the same topic is told on both sides") {
  Outbox early(*writing, {"early", "test::One", false}, keep_all());
  Inbox inbox(*reading, {"early", "test::Other", false}, keep_all());
  Inbox waiting(*reading, {"late", "test::Other", false}, keep_all());
  Outbox late(*writing, {"late", "test::One", false}, keep_all());
  for (Outbox* outbox : {&early, &late}) {
    REQUIRE(eventually([&] { return !outbox->incompatible().empty(); }));
    CHECK(outbox->incompatible().front().offered == "test::One");
    CHECK(outbox->incompatible().front().requested == "test::Other");
    CHECK(outbox->writer().matched_readers().empty());
  }
  for (const auto* each : {&inbox, &waiting}) {
    REQUIRE(eventually([&] { return !each->incompatible().empty(); }));
    CHECK(each->incompatible().front().policy == "type");
    CHECK_THAT(each->incompatible().front().explanation,
               Catch::Contains("the writer offers test::One, the reader requests test::Other"));
    CHECK_THAT(each->incompatible().front().explanation,
               Catch::Contains("(the other side is conformance)"));  // its participant's name
  }
}

TEST_CASE_METHOD(
    Wire, "a writer of another version of the type is not matched, and nothing of it is taken") {
  Qos right = keep_all();
  right.transient_local = true;
  right.exclusive = true;
  right.type.signature = 1;
  Qos wrong = right;
  wrong.type.signature = 2;
  wrong.strength = 9;
  Outbox changed(*writing, keyless(), wrong);
  for (std::uint32_t i = 0; i < 10; ++i) changed.writer().write(make_number(i));
  Inbox inbox(*reading, keyless(), right);
  REQUIRE(
      eventually([&] { return !inbox.incompatible().empty() && !changed.incompatible().empty(); }));
  Outbox same(*writing, keyless(), right);
  same.writer().write(make_number(11));
  changed.writer().write(make_number(12));
  same.writer().write(make_number(13));
  REQUIRE(eventually([&] { return inbox.count() >= 2; }));
  CHECK(numbers(inbox.received()) == std::vector<std::uint32_t>{11, 13});
  CHECK(inbox.reader().matched_writers() == std::vector{same.writer().guid()});
  CHECK(changed.writer().matched_readers().empty());
  CHECK(eventually([&] { return inbox.matches() == Events{{same.writer().guid(), true}}; }));
}

TEST_CASE_METHOD(Wire, "a topic name that is in use with another type is refused") {
  const auto writer = writing->create_writer({"taken", "test::One", false}, keep_all());
  CHECK_THROWS_WITH(
      writing->create_reader({"taken", "test::Other", false}, keep_all()),
      Catch::Contains("taken") && Catch::Contains("test::One") && Catch::Contains("test::Other"));
  CHECK_THROWS_AS(writing->create_writer({"taken", "test::One", true}, keep_all()),
                  InvalidArgument);
}

TEST_CASE_METHOD(Wire, "a topic name is free again when its last user has gone") {
  writing->create_writer({"reused", "test::One", false}, keep_all());
  CHECK_NOTHROW(writing->create_writer({"reused", "test::Other", false}, keep_all()));
}
