// What strangers say in sequences of well-formed packets, drawn at random. SKEIN_SEQUENCE_PACKETS
// says how many; SKEIN_SEED which.
#include <catch2/catch.hpp>
#include <cstdio>

#include "attacked_provider.hpp"
#include "test/tools/packet_sequences.hpp"
#include "test/tools/seed.hpp"

using namespace skein;
using namespace skein::test;
using namespace std::chrono_literals;

namespace {

constexpr std::size_t kMoreMemory = 64;  // MiB

std::uint64_t packets_to_send() {
  constexpr std::uint64_t kSomeSeconds = 50'000;
  const char* given = std::getenv("SKEIN_SEQUENCE_PACKETS");
  return given != nullptr ? std::stoull(given) : kSomeSeconds;
}

/// The least that a hundred calls take of ten times: what else the machine does is not counted.
std::chrono::duration<double> time_of_calls(ChildProcess& client) {
  auto least = std::chrono::steady_clock::duration::max();
  for (int i = 0; i < 10; ++i) {
    const auto start = std::chrono::steady_clock::now();
    const std::string answer = client.ask("echo 100 hello", 30s);
    if (!answer.starts_with("echoed")) throw std::runtime_error("a call ended with " + answer);
    least = std::min(least, std::chrono::steady_clock::now() - start);
  }
  return least;
}

}  // namespace

TEST_CASE("after sequences of packets a provider answers as soon, and holds little more memory") {
  AttackedProvider provider;
  auto client = start_peer("client", *Pairing::get().client);
  REQUIRE_THAT(client.ask("connect"), Catch::StartsWith("connected"));
  const auto before = time_of_calls(client);
  const std::size_t memory = provider.resident_mib();

  using Provider = AttackedProvider;
  PacketSequences sequences({{Provider::kRequestTopic, Provider::kRequestType, false},
                             {Provider::kReplyTopic, Provider::kReplyType, true},
                             {"test/Nobody", "test::Nobody", false}},
                            seed_of_this_run());
  const std::uint64_t count = packets_to_send();
  const auto start = std::chrono::steady_clock::now();
  std::size_t most = memory;
  for (std::uint64_t sent = 0; sent < count; ++sent) {
    INFO("after " << sent << " packets");
    REQUIRE_NOTHROW(provider.send(sequences.next()));
    if (sent % 1000 == 0) most = std::max(most, provider.resident_mib());
  }
  CHECK(provider.has_read_all(30s));
  const std::chrono::duration<double> time = std::chrono::steady_clock::now() - start;

  CHECK(eventually([&] { return provider.resident_mib() <= memory + kMoreMemory; }));
  CHECK(eventually([&] { return time_of_calls(client) <= 2 * before; }));
  provider.check_answers();
  std::printf("%s: %llu packets in %.0f s; %zu MiB before, %zu at most, %zu after\n",
              Pairing::get().server->name().c_str(), static_cast<unsigned long long>(count),
              time.count(), memory, most, provider.resident_mib());
}
