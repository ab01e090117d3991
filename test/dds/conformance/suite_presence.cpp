#include <catch2/catch.hpp>

#include "wire.hpp"

using namespace skein;
using namespace skein::dds;
using namespace skein::dds::conformance;
using skein::test::eventually;
using namespace std::chrono_literals;

namespace {

using Events = std::vector<std::pair<Guid, bool>>;

/// A participant that keeps what it is told of others.
struct Watcher {
  Watcher(const std::string& vendor, std::uint32_t domain) {
    ParticipantOptions options;
    options.domain = domain;
    options.lease = 10s;
    options.network.max_participants = 12;
    options.on_participant = [this](const Guid& participant, bool present) {
      std::lock_guard lock(mutex);
      events.emplace_back(participant, present);
    };
    participant = load_vendor(vendor)->create_participant(options);
  }
  Events told() const {
    std::lock_guard lock(mutex);
    return events;
  }
  mutable std::mutex mutex;
  Events events;
  std::unique_ptr<Participant> participant;
};

}  // namespace

TEST_CASE("participants of one domain find each other, and learn at once who leaves") {
  const std::uint32_t domain = fresh_domain();
  Watcher staying(kPairing.reading, domain);
  auto leaving = std::make_unique<Watcher>(kPairing.writing, domain);
  const Guid stays = staying.participant->guid();
  const Guid leaves = leaving->participant->guid();
  CHECK(leaves == leaves.participant());
  REQUIRE(eventually([&] { return staying.told() == Events{{leaves, true}}; }));
  REQUIRE(eventually([&] { return leaving->told() == Events{{stays, true}}; }));
  const auto before = std::chrono::steady_clock::now();
  leaving.reset();
  REQUIRE(eventually([&] { return staying.told() == Events{{leaves, true}, {leaves, false}}; }));
  CHECK(std::chrono::steady_clock::now() - before < 10s);  // a goodbye, not the lease
}

TEST_CASE("participants of different domains do not find each other") {
  const std::uint32_t domain = fresh_domain();
  Watcher one(kPairing.reading, domain);
  Watcher other(kPairing.writing, fresh_domain());
  Watcher same(kPairing.writing, domain);
  REQUIRE(eventually([&] { return !one.told().empty(); }));
  CHECK(one.told() == Events{{same.participant->guid(), true}});
  CHECK(other.told().empty());
}

TEST_CASE_METHOD(Wire, "a participant that leaves takes its endpoints along") {
  auto outbox = std::make_unique<Outbox>(*writing, keyless(), keep_all());
  Inbox inbox(*reading, keyless(), keep_all());
  REQUIRE(matched(*outbox, inbox));
  outbox.reset();
  writing.reset();
  REQUIRE(eventually([&] { return inbox.reader().matched_writers().empty(); }));
  writing = make_participant(kPairing.writing, domain);
  Outbox again(*writing, keyless(), keep_all());
  REQUIRE(matched(again, inbox));
  again.writer().write(make_number(1));
  REQUIRE(eventually([&] { return inbox.count() == 1; }));
}

TEST_CASE_METHOD(Wire, "several participants of one process and vendor are independent") {
  const auto third = make_participant(kPairing.writing, domain);
  const auto fourth = make_participant(kPairing.reading, domain);
  Outbox one(*writing, keyless(), keep_all());
  Outbox other(*third, keyless(), keep_all());
  Inbox left(*reading, keyless(), keep_all());
  Inbox right(*fourth, keyless(), keep_all());
  for (Outbox* outbox : {&one, &other}) {
    REQUIRE(matched(*outbox, left));
    REQUIRE(matched(*outbox, right));
    outbox->writer().write(make_number(1));
  }
  CHECK(eventually([&] { return left.count() == 2 && right.count() == 2; }));
}
