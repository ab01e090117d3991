// What strangers send: single packets that end or deafen an unguarded peer, and mutations of good
// ones. SKEIN_FUZZ_PACKETS says how many of the latter; SKEIN_SEED which.
#include <catch2/catch.hpp>
#include <cstdio>

#include "fuzzed_provider.hpp"
#include "test/tools/packet_mutator.hpp"
#include "test/tools/seed.hpp"

using namespace skein;
using namespace skein::test;

namespace {

using MakePacket = RtpsPacket (*)(const Guid& writer);

void check_survives(MakePacket make) {
  FuzzedProvider provider;
  REQUIRE_FALSE(provider.writers().empty());
  for (const Guid& writer : provider.writers()) {
    provider.send(make(writer).octets());
    REQUIRE_NOTHROW(provider.check_unharmed());
  }
}

std::uint64_t packets_to_send() {
#ifdef __SANITIZE_ADDRESS__
  constexpr std::uint64_t kSomeSeconds = 20'000;
#else
  constexpr std::uint64_t kSomeSeconds = 100'000;
#endif
  const char* given = std::getenv("SKEIN_FUZZ_PACKETS");
  return given != nullptr ? std::stoull(given) : kSomeSeconds;
}

/// Kinds of submessages that the capture may not have.
std::vector<Octets> made_packets(const Guid& writer) {
  const auto packet = [&](unsigned kind, unsigned flags, const OctetWriter& body) {
    return RtpsPacket(writer).submessage(kind, flags, body).octets();
  };
  const Octets payload(64, 1);
  return {
      packet(0x07, 0, heartbeat(writer, 1, 30, 1000)),
      packet(0x08, 0, gap(writer, 20, 24)),
      packet(0x15, kHasPayload, data(writer, 40, payload)),
      packet(0x16, 0, data_frag(writer, 41, {1, 1, 1024, 9000}, 1024)),
      packet(0x16, 0, data_frag(writer, 41, {9, 1, 1024, 9000}, 808)),
      packet(0x13, 0, entities({}, writer).number(41).u32(9).u32(1000)),
      packet(0x12, 0, entities({}, writer).number(41).u32(1).u32(32).u32(~0u).u32(1000)),
      packet(0x06, 0, entities({}, writer).number(5).u32(32).u32(~0u).u32(1000)),
      packet(0x80, 0, OctetWriter().zeros(56)),
      packet(0x0c, 0, OctetWriter().zeros(20)),
      packet(0x0f, 0, OctetWriter().u32(1).zeros(24)),
  };
}

}  // namespace

TEST_CASE("84 bytes of statistics with something behind them do not end a provider") {
  check_survives([](const Guid& writer) {
    return RtpsPacket(writer)
        .submessage(0x80, 0, OctetWriter().zeros(56))
        .append(OctetWriter().zeros(4));
  });
}

TEST_CASE("one fragment that claims 100 MB does not end a provider") {
  check_survives([](const Guid& writer) {
    return RtpsPacket(writer).submessage(
        0x16, 0, data_frag(writer, 1000, {1, 1539, 65000, 100'000'000}, 64));
  });
}

TEST_CASE("one heartbeat that leaps by 2^52 does not occupy a provider") {
  check_survives([](const Guid& writer) {
    const std::int64_t far = std::int64_t{1} << 52;
    return RtpsPacket(writer).submessage(0x07, 0, heartbeat(writer, far, far, 0x7fffffff));
  });
}

TEST_CASE("one gap of 2^40 samples does not take a provider's memory") {
  check_survives([](const Guid& writer) {
    return RtpsPacket(writer).submessage(0x08, 0, gap(writer, 100'000, std::int64_t{1} << 40));
  });
}

TEST_CASE("fragments of three bytes do not end a provider") {
  check_survives([](const Guid& writer) {
    RtpsPacket packet(writer);
    for (const std::uint32_t first : {5u, 3u, 90u, 1u, 40u}) {
      packet.submessage(0x16, 0, data_frag(writer, 1000, {first, 10, 3, 300}, 32));
    }
    return packet;
  });
}

TEST_CASE("mutated packets leave a provider alive, idle and answering") {
  FuzzedProvider provider;
  std::vector<Octets> good = provider.packets();
  for (const Guid& writer : provider.writers()) {
    for (Octets& made : made_packets(writer)) good.push_back(std::move(made));
  }
  PacketMutator mutator(good, seed_of_this_run());
  const std::uint64_t count = packets_to_send();
  const auto begin = std::chrono::steady_clock::now();
  std::uint64_t sent = 0;
  try {
    for (; sent < count; ++sent) provider.send(mutator.next());
    provider.check_unharmed();
  } catch (const std::runtime_error& error) {
    FAIL("after " << sent << " mutated packets: " << error.what() << "\nthe last ones were\n"
                  << provider.last_packets());
  }
  const std::chrono::duration<double> time = std::chrono::steady_clock::now() - begin;
  std::printf("%s: %llu mutated packets in %.0f s\n", Pairing::get().server->name().c_str(),
              static_cast<unsigned long long>(count), time.count());
}
