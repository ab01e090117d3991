#include <arpa/inet.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <unistd.h>

#include <catch2/catch.hpp>
#include <thread>

#include "../tools/rtps_packet.hpp"
#include "wire.hpp"

using namespace skein;
using namespace skein::dds;
using namespace skein::dds::conformance;
using namespace skein::test;
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

Guid builtin(const Guid& participant, unsigned number, unsigned kind) {
  Guid guid = participant;
  guid.bytes[13] = static_cast<std::uint8_t>(number >> 8);
  guid.bytes[14] = static_cast<std::uint8_t>(number);
  guid.bytes[15] = static_cast<std::uint8_t>(kind);
  return guid;
}

/// The participant's word that it has gone.
RtpsPacket farewell(const Guid& participant) {
  const Guid self = builtin(participant, 1, 0xc1);
  const auto announcer = builtin(participant, 0x100, 0xc2);
  const auto detector = builtin({}, 0x100, 0xc7);
  OctetWriter gone = OctetWriter().u16(0).u16(16).append(entities(detector, announcer).octets());
  gone.number(1000).u16(0x70).u16(16).append(self.bytes);
  gone.u16(0x71).u16(4).u8(0).u8(0).u8(0).u8(3).u16(1).u16(0);
  return RtpsPacket(participant).submessage(0x15, 0x02, gone);
}

/// The participant's word that it has written about one writer.
RtpsPacket heartbeat_of_publications(const Guid& participant) {
  const Guid writer = builtin(participant, 3, 0xc2);
  return RtpsPacket(participant)
      .submessage(0x07, 0, heartbeat(writer, 1, 1, 1, builtin({}, 3, 0xc7)));
}

bool forgot(const Inbox& inbox) {
  for (const auto& [writer, matched] : inbox.matches()) {
    if (!matched) return true;
  }
  return false;
}

}  // namespace

TEST_CASE("who forgets a participant that has not forgotten it finds all its endpoints again") {
  Wire wire;
  Outbox outbox(*wire.writing, keyed(), last_state());
  Inbox inbox(*wire.reading, keyed(), last_state());
  REQUIRE(matched(outbox, inbox));
  const Guid writing = wire.writing->guid();
  // Input: they know each other for longer than the period of discovery's heartbeats. By then what
  // was said is acknowledged.
  std::this_thread::sleep_for(1200ms);
  const Forger forger(wire.domain);
  REQUIRE(eventually([&] {
    forger.send(farewell(writing));
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
    const std::uint32_t domain = fresh_domain();
    const auto early = make_participant(kPairing.reading, domain);
    const auto late = make_participant(kPairing.writing, domain);
    // Input: how far they have come with finding each other, from nowhere to all the way.
    std::this_thread::sleep_for(round * 4ms);
    Inbox inbox(*early, keyed(), last_state());
    Outbox outbox(*late, keyed(), last_state());
    Inbox managed(*early, keyed("conformance_managed"), last_state());
    Outbox manager(*late, keyed("conformance_managed"), last_state());
    REQUIRE(matched(outbox, inbox));
    REQUIRE(matched(manager, managed));
  }
}
