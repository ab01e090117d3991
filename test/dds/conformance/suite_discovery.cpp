#include <arpa/inet.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <unistd.h>

#include <catch2/catch.hpp>
#include <chrono>
#include <cstring>
#include <set>

#include "dds/rtps/rtps_message.hpp"
#include "test/tools/rtps_packet.hpp"
#include "test/tools/wire_tap.hpp"
#include "wire.hpp"

using namespace skein;
using namespace skein::dds;
using namespace skein::dds::conformance;
using namespace skein::test;
using namespace skein::test::entity_id;
using namespace std::chrono_literals;

namespace {

/// Sends to where a domain's first participants hear of each other.
class Forger {
 public:
  explicit Forger(std::uint32_t domain)
      : socket_(socket(AF_INET, SOCK_DGRAM, 0)), first_port_(7410 + 250 * domain) {}
  Forger(const Forger&) = delete;
  ~Forger() { close(socket_); }

  void send(const RtpsPacket& packet) const {
    constexpr std::uint32_t kPorts = 12;
    for (std::uint32_t i = 0; i < kPorts; ++i) {
      sockaddr_in address{};
      address.sin_family = AF_INET;
      address.sin_port = htons(static_cast<std::uint16_t>(first_port_ + 2 * i));
      address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
      const Octets& octets = packet.octets();
      sendto(socket_, octets.data(), octets.size(), 0, reinterpret_cast<sockaddr*>(&address),
             sizeof address);
    }
  }

 private:
  const int socket_;
  const std::uint32_t first_port_;
};

/// The participant's word that it has written about one writer.
RtpsPacket heartbeat_of_publications(const Guid& participant) {
  const Guid writer = with_entity(participant, kPublicationsAnnouncer);
  const Guid reader = with_entity(participant, kPublicationsDetector);
  return RtpsPacket(participant).submessage(0x07, 0, heartbeat(writer, 1, 1, 1, reader));
}

/// The participant's word that it has heard of another's one writer.
RtpsPacket acknowledgment_of_publications(const Guid& participant, const Guid& other,
                                          std::uint32_t count) {
  OctetWriter body = entities(with_entity(participant, kPublicationsDetector),
                              with_entity(other, kPublicationsAnnouncer));
  body.number(2).u32(0).u32(count);
  constexpr std::uint8_t kFinal = 0x02;
  return RtpsPacket(participant).submessage(0x06, kFinal, body);
}

/// Each submessage of a packet, if it is one of RTPS.
template <class Visit>
void for_each_submessage_of(const Packet& packet, Visit&& visit) {
  auto octets = packet.content;
  auto* message = reinterpret_cast<unsigned char*>(octets.data());
  if (octets.size() < rtps_message::kRtpsHeaderSize || std::memcmp(message, "RTPS", 4) != 0) return;
  rtps_message::for_each_submessage(message, octets.size(), visit);
}

/// Whether the participant acknowledges that it has heard of a writer.
bool acknowledges_a_writer(const Packet& packet, const Guid& participant) {
  constexpr unsigned char kWriter[] = {0, 0, 3, 0xc2};  // that announces writers
  bool found = false;
  for_each_submessage_of(packet, [&](const rtps_message::Submessage& each) {
    if (each.kind() != rtps_message::kAckNack || each.size < 16) return;
    const auto* sender = packet.content.data() + rtps_message::kPrefix;
    found |= std::memcmp(sender, participant.bytes.data(), rtps_message::kPrefixSize) == 0 &&
             std::memcmp(each.body() + 4, kWriter, sizeof kWriter) == 0 &&
             rtps_message::get_sequence_number(each.body() + 8, each.little()) > 1;
  });
  return found;
}

/// Whether it is for one participant alone.
bool is_directed(const Packet& packet) {
  bool found = false;
  for_each_submessage_of(packet, [&](const rtps_message::Submessage& each) {
    found |= each.kind() == rtps_message::kInfoDestination;
  });
  return found;
}

/// The encapsulations in which the participant says that its writers live.
std::set<int> encapsulations_of_liveliness(const Packet& packet, const Guid& participant) {
  constexpr unsigned char kWriter[] = {0, 2, 0, 0xc2};  // that says so
  std::set<int> found;
  for_each_submessage_of(packet, [&](const rtps_message::Submessage& each) {
    const auto* sender = packet.content.data() + rtps_message::kPrefix;
    if (std::memcmp(sender, participant.bytes.data(), rtps_message::kPrefixSize) != 0) return;
    if (each.kind() != rtps_message::kData) return;
    const auto data = rtps_message::data(each);
    if (!data || data->payload_size == 0) return;
    if (std::memcmp(data->writer, kWriter, sizeof kWriter) == 0) found.insert(data->payload[1]);
  });
  return found;
}

bool forgot(const Inbox& inbox) {
  for (const auto& [writer, matched] : inbox.matches()) {
    if (!matched) return true;
  }
  return false;
}

}  // namespace

// Cyclone DDS 0.10.5 refuses all others, and logs each.
TEST_CASE("that writers live is said in plain CDR, as the specification wants it") {
  const std::set<int> little_endian_cdr{1};
  const WireTap tap;
  Wire wire;
  Qos qos = last_state();
  qos.liveliness_lease = 300ms;
  Outbox outbox(*wire.writing, keyed(), qos);
  Inbox inbox(*wire.reading, keyed(), qos);
  const auto said = [&](const Packet& each) {
    return encapsulations_of_liveliness(each, wire.writing->guid());
  };
  REQUIRE(eventually(
      [&] { return tap.count([&](const Packet& each) { return !said(each).empty(); }) > 0; }));
  CHECK(tap.count([&](const Packet& each) {
    return !said(each).empty() && said(each) != little_endian_cdr;
  }) == 0);
}

TEST_CASE("who forgets a participant that has not forgotten it finds all its endpoints again") {
  const WireTap tap;
  Wire wire;
  Outbox outbox(*wire.writing, keyed(), last_state());
  Inbox inbox(*wire.reading, keyed(), last_state());
  REQUIRE(matched(outbox, inbox));
  const Guid writing = wire.writing->guid();
  const Guid reading = wire.reading->guid();
  // What was acknowledged is not sent again by itself.
  REQUIRE(eventually([&] {
    return tap.count([&](const Packet& each) { return acknowledges_a_writer(each, reading); }) > 0;
  }));
  const Forger forger(wire.domain);
  SECTION("after a short acquaintance") {}
  SECTION("after a long one, in which it acknowledged often") {
    forger.send(acknowledgment_of_publications(reading, writing, 1000));
  }
  REQUIRE(eventually([&] {
    forger.send(farewell(writing, 1000));
    return forgot(inbox);
  }));
  // Of all that the forgotten one may say, a heartbeat comes first.
  CHECK(eventually([&] {
    forger.send(heartbeat_of_publications(writing));
    return !inbox.reader().matched_writers().empty();
  }));
  outbox.writer().write(make_sample(8), make_key(1));
  CHECK(eventually([&] { return inbox.count() == 1; }));
}

TEST_CASE("endpoints that are made while participants find each other are found") {
  constexpr int kRounds = 10;
  for (int round = 0; round < kRounds; ++round) {
    INFO("round " << round);
    const WireTap tap;
    const std::uint32_t domain = fresh_domain();
    const auto early = make_participant(kPairing.reading, domain);
    const auto late = make_participant(kPairing.writing, domain);
    // How far they have come with finding each other, from nowhere to all the way.
    REQUIRE(eventually([&] { return tap.count(is_directed) >= round; }));
    Inbox inbox(*early, keyed(), last_state());
    Outbox outbox(*late, keyed(), last_state());
    Inbox managed(*early, keyed("conformance_managed"), last_state());
    Outbox manager(*late, keyed("conformance_managed"), last_state());
    REQUIRE(matched(outbox, inbox));
    REQUIRE(matched(manager, managed));
  }
}
