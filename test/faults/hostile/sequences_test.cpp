// What strangers send after they have announced themselves: a few packets each of which is well
// formed, and true of its sender as far as the provider can know.
#include <catch2/catch.hpp>

#include "attacked_provider.hpp"
#include "dds/port/port.hpp"
#include "dds/rtps/packet_admission.hpp"
#include "skein/detail/bytes.hpp"
#include "skein/error.hpp"
#include "test/tools/cable.hpp"
#include "test/tools/wire_tap.hpp"

using namespace skein;
using namespace skein::test;
using namespace std::chrono_literals;

namespace {

constexpr unsigned kHeartbeat = 0x07;
constexpr unsigned kGap = 0x08;
constexpr unsigned kDataFrag = 0x16;
constexpr std::size_t kLittleMemory = 64;  // MiB

/// A participant of the test's own process, and strangers that speak to it.
struct Stage {
  Stage() {
    dds::ParticipantOptions options;
    options.domain = 17;
    participant = Pairing::get().server->create_participant(options);
  }
  void send(const RtpsPacket& packet) {
    for (const std::uint16_t port : receiving_ports_of(getpid())) {
      socket.send(packet.octets(), port);
    }
  }

  const dds::Topic topic{"test/Sequences", "test::Sequences", false};
  std::unique_ptr<dds::Participant> participant;
  RawSocket socket;
};

}  // namespace

TEST_CASE_METHOD(AttackedProvider,
                 "a heartbeat whose numbers begin at 2^32 does not stop a provider") {
  const InventedPeer peer(1);
  const std::int64_t far = std::int64_t{1} << 32;
  SECTION("of the writer that announces endpoints") {
    const Guid writer = peer.entity(entity_id::kPublicationsAnnouncer);
    send(peer.announcement());
    send(peer.says(kHeartbeat, heartbeat(writer, far, far)));
  }
  SECTION("of a writer of requests") {
    const Guid writer = peer.writer(1);
    introduce(peer);
    check_answers();  // by then the writer is matched
    for (std::uint32_t i = 1; i <= 20; ++i) {
      send(peer.says(kHeartbeat, heartbeat(writer, far, far, i)));
    }
  }
  CHECK(has_read_all(kPatience));
  check_answers();
}

TEST_CASE_METHOD(AttackedProvider,
                 "gaps behind a number that is missing take little of a provider's memory") {
  const InventedPeer peer(1);
  introduce(peer);
  const Guid writer = peer.writer(1);
  check_answers();  // by then the writer is matched
  const std::size_t before = resident_mib();
  send(peer.says(kHeartbeat, heartbeat(writer, 1, std::int64_t{1} << 32)));
  for (std::int64_t i = 0; i < 300; ++i) {
    const std::int64_t start = 2 + i * 65'536;
    send(peer.says(kGap, gap(writer, start, start + 65'535)));
  }
  CHECK(has_read_all(kPatience));
  CHECK(resident_mib() <= before + kLittleMemory);
  check_answers();
}

TEST_CASE_METHOD(
    AttackedProvider,
    "a fragment that claims a large sample takes little of a provider's memory, for seconds") {
  const InventedPeer peer(1);
  introduce(peer);
  check_answers();  // by then the writer is matched
  const std::size_t before = resident_mib();
  for (const std::uint32_t claimed : {256u << 20, 20u << 20}) {
    for (int i = 1; i <= 24; ++i) {
      const FragmentClaim claim{1, 1, 256, claimed};
      send(peer.says(kDataFrag, data_frag(peer.writer(1), i, claim, 256)));
    }
  }
  CHECK(has_read_all(kPatience));
  CHECK(resident_mib() <= before + kLittleMemory);
  CHECK(eventually([&] { return resident_mib() <= before + 8; }));
  check_answers();
}

TEST_CASE_METHOD(AttackedProvider, "fragments of writers that nobody reads keep no sample out") {
  const InventedPeer peer(1);
  send(peer.announcement());
  for (std::uint32_t i = 1; i <= 8; ++i) {
    const FragmentClaim claim{1, 1, 256, 256u << 20};
    send(peer.says(kDataFrag, data_frag(peer.writer(i), 1, claim, 256)));
    send(InventedPeer(1 + i).says(kDataFrag, data_frag(peer.writer(i), 1, claim, 256)));
  }
  CHECK(has_read_all(kPatience));
  check_answers(4s);
}

TEST_CASE("a reader that never acknowledges takes a bounded part of a writer's memory") {
  Stage stage;
  const auto writer = stage.participant->create_writer(stage.topic, {});
  const InventedPeer peer(1);
  REQUIRE(eventually([&] {
    stage.send(peer.announcement());
    stage.send(peer.endpoint(peer.reader(1), stage.topic.name, stage.topic.type_name, 1));
    return !writer->matched_readers().empty();
  }));
  Bytes sample;
  sample.resize(1 << 20);
  std::memset(sample.data(), 0, sample.size());
  sample.data()[1] = std::byte{1};  // PLAIN_CDR, little-endian
  int written = 0;
  const auto write_all = [&] {
    for (; written < 64; ++written) writer->write(sample);
  };
  CHECK_THROWS_AS(write_all(), Overloaded);
  CHECK(written <= 8);
}

TEST_CASE("who withdraws another's endpoint in its own name withdraws nothing") {
  Stage stage;
  dds::ParticipantOptions options;
  options.domain = 17;
  const auto other = Pairing::get().server->create_participant(options);
  const auto reader = stage.participant->create_reader(stage.topic, {});
  const auto writer = other->create_writer(stage.topic, {});
  const auto matched = [&](const Guid& guid) {
    const auto writers = reader->matched_writers();
    return std::ranges::count(writers, guid) > 0;
  };
  REQUIRE(eventually([&] { return matched(writer->guid()); }));
  const InventedPeer peer(1);
  REQUIRE(eventually([&] {
    stage.send(peer.announcement());
    stage.send(peer.endpoint(peer.writer(1), stage.topic.name, stage.topic.type_name, 1));
    return matched(peer.writer(1));
  }));
  stage.send(peer.withdrawal(writer->guid(), 2));
  // It has seen that when it has seen what follows.
  REQUIRE(eventually([&] {
    stage.send(peer.endpoint(peer.writer(2), stage.topic.name, stage.topic.type_name, 3));
    stage.send(peer.endpoint(peer.writer(2), stage.topic.name, stage.topic.type_name, 2));
    return matched(peer.writer(2));
  }));
  CHECK(matched(writer->guid()));
}

TEST_CASE_METHOD(AttackedProvider,
                 "endpoints announced without end take a bounded part of a provider's memory") {
  constexpr std::uint32_t kMany = 60'000;
  const InventedPeer peer(1);
  send(peer.announcement());
  const std::size_t before = resident_mib();
  for (std::uint32_t i = 1; i <= kMany; ++i) {
    send(peer.endpoint(peer.writer(i), "announced", "announced", i));
  }
  CHECK(has_read_all(30s));
  CHECK(resident_mib() <= before + kLittleMemory);
  send(farewell(peer.entity(entity_id::kParticipant), 2));
  check_answers();
}

TEST_CASE_METHOD(AttackedProvider,
                 "announcements behind a missing one take a bounded part of a provider's memory") {
  constexpr std::int64_t kMany = 30'000;
  const InventedPeer peer(1);
  send(peer.announcement());
  const std::size_t before = resident_mib();
  for (std::int64_t i = 2; i <= kMany; ++i) {
    send(peer.endpoint(peer.writer(1), "announced", "announced", i));
  }
  CHECK(has_read_all(5s));
  CHECK(resident_mib() <= before + kLittleMemory);
  check_answers();
}

TEST_CASE("who withdraws endpoints may announce others, however many it has had") {
  constexpr std::size_t kSize = 50'000;
  constexpr std::uint32_t kMany = dds::Admission::kMaxAnnounced / kSize + 16;
  Stage stage;
  const auto reader = stage.participant->create_reader(stage.topic, {});
  const InventedPeer peer(1);
  const auto matched = [&] { return !reader->matched_writers().empty(); };
  REQUIRE(eventually([&] {
    stage.send(peer.announcement());
    stage.send(peer.endpoint(peer.writer(1), stage.topic.name, stage.topic.type_name, 1));
    return matched();
  }));
  const auto ports = receiving_ports_of(getpid());
  for (std::uint32_t i = 2; i < kMany; ++i) {
    const auto number = 2 * std::int64_t{i} - 2;
    stage.send(peer.withdrawal(peer.writer(i - 1), number));
    stage.send(peer.endpoint(peer.writer(i), "announced", "announced", number + 1, kSize));
    REQUIRE(eventually([&] { return unread_bytes(ports) == 0; }));
  }
  CHECK(eventually([&] { return !matched(); }));
  CHECK(eventually([&] {
    stage.send(peer.endpoint(peer.writer(kMany), stage.topic.name, stage.topic.type_name,
                             2 * std::int64_t{kMany} - 2));
    return matched();
  }));
}

TEST_CASE_METHOD(AttackedProvider,
                 "thousands of invented participants keep no call from its answer") {
  constexpr std::uint32_t kNever = 0x7fffffff;
  const auto start = std::chrono::steady_clock::now();
  for (std::uint32_t i = 1; i <= 3000; ++i) send(InventedPeer(i).announcement(kNever));
  CHECK(has_read_all(10s));
  CHECK(std::chrono::steady_clock::now() - start < 10s);
  check_answers();
}

TEST_CASE_METHOD(AttackedProvider,
                 "nobody is sent anything because a stranger has named his address") {
  constexpr std::uint32_t kVictim = 127u << 24 | 77;
  WireTap tap;
  const InventedPeer liar(1, kVictim);
  const InventedPeer honest(2);
  introduce(liar);
  introduce(honest);
  const auto sent_to = [&](std::uint32_t address, std::uint16_t port) {
    return tap.count([=](const Packet& packet) {
      return packet.destination == address && packet.destination_port == port;
    });
  };
  constexpr int kManyTimes = 3;
  CHECK(eventually([&] { return sent_to(127u << 24 | 1, InventedPeer::kPort) >= kManyTimes; }));
  CHECK(sent_to(kVictim, InventedPeer::kPort) == 0);
  check_answers();
}

TEST_CASE("who is not among a profile's allowed sources is shut out, whatever it announces") {
  constexpr std::uint32_t kOwn = 10u << 24 | 77 << 16 | 1;
  constexpr std::uint32_t kFriend = kOwn + 1;
  constexpr std::uint32_t kStranger = kOwn + 65;
  const NetworkSpace here;
  const NetworkSpace there;
  const Cable cable(here, there, 1);
  there.run("ip addr add 10.77.0.66/24 dev skein0");
  std::optional<RawSocket> from_stranger;
  std::optional<RawSocket> from_friend;
  {
    const Inside inside(there);
    from_stranger.emplace(kStranger);
    from_friend.emplace(kFriend);
  }
  const Inside inside(here);
  dds::ParticipantOptions options;
  options.domain = 17;
  options.network.interfaces = {"10.77.0.1"};
  options.network.peers = {"10.77.0.2"};
  options.network.allowed_sources = {"10.77.0.2"};
  const auto participant = Pairing::get().server->create_participant(options);
  const dds::Topic topic{"test/Sequences", "test::Sequences", false};
  const auto reader = participant->create_reader(topic, {});
  const InventedPeer stranger(1, kStranger);
  const InventedPeer known(2, kFriend);
  const auto introduce = [&](const RawSocket& socket, const InventedPeer& peer) {
    constexpr std::uint16_t kDiscovery = 7400 + 250 * 17 + 10;  // RTPS 9.6.1
    const auto endpoint = peer.endpoint(peer.writer(1), topic.name, topic.type_name, 1);
    socket.send(peer.announcement().octets(), kDiscovery, kOwn);
    socket.send(endpoint.octets(), kDiscovery, kOwn);
  };
  CHECK(eventually([&] {
    introduce(*from_stranger, stranger);
    introduce(*from_friend, known);
    return !reader->matched_writers().empty();
  }));
  introduce(*from_stranger, stranger);
  // What comes behind it has been received: a farewell.
  CHECK(eventually([&] {
    from_friend->send(farewell(known.entity(entity_id::kParticipant), 2).octets(),
                      7400 + 250 * 17 + 10, kOwn);
    const auto writers = reader->matched_writers();
    CHECK(std::ranges::count(writers, stranger.writer(1)) == 0);
    return writers.empty();
  }));
}
