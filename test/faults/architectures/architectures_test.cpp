#include <catch2/catch.hpp>
#include <csignal>
#include <cstdio>
#include <numeric>

#include "brokerless_discovery/broker.hpp"
#include "test/connector/echo_service.hpp"
#include "test/faults/processes.hpp"
#include "test/tools/places.hpp"
#include "test/tools/prepare.hpp"

// A peer for arm64, which runs under qemu, and this process on one host: over DDS, or through
// shared memory if SKEIN_SHARED_MEMORY_CALLS is set.
using namespace skein;
using namespace skein::test;
using namespace std::chrono_literals;
using ::test::LouderEcho;

namespace {

/// An emulated process begins slowly.
constexpr auto kLongPatience = 100s;
/// So long that a death is noticed by other means.
constexpr std::chrono::milliseconds kLongLease{120'000};
constexpr std::size_t kLarge = 3'000'000;

std::string foreign_peer() { return project_file("build/arm64/bin/faults_peer"); }

ChildProcess start(const std::string& program, const std::string& name, const dds::Vendor& vendor,
                   std::chrono::milliseconds lease = kLongLease) {
  return {program,
          {.arguments = {"vendor=" + vendor.name(), "name=" + name,
                         "lease=" + std::to_string(lease.count())}}};
}

ChildProcess start_foreign_provider() {
  auto peer = start(foreign_peer(), "server", *Pairing::get().server);
  peer.send("provide");
  peer.expect("provided", kLongPatience);
  return peer;
}

ChildProcess start_foreign_client(std::chrono::milliseconds lease = kLongLease) {
  auto peer = start(foreign_peer(), "client", *Pairing::get().client, lease);
  peer.send("connect");
  peer.expect("connected", kLongPatience);
  return peer;
}

const char* expected_transport() {
  return std::getenv("SKEIN_SHARED_MEMORY_CALLS") ? "shared memory" : "DDS";
}

bool nobody_provides(Entity& entity) {
  const auto& broker = entity.broker();
  return eventually([&] { return broker.find_service(broker.query("test::Echo")).empty(); });
}

}  // namespace

int skein::test::prepare() {
  constexpr int kSkipped = 77;
  if (std::FILE* const file = std::fopen(foreign_peer().c_str(), "r")) {
    std::fclose(file);
  } else {
    std::printf("skipped: there is no %s, which ./dev test --arm64 builds\n",
                foreign_peer().c_str());
    return kSkipped;
  }
  // Without an entity it ends with its input.
  if (ChildProcess(foreign_peer(), {.arguments = {"vendor=loopback"}}).finish() != 0) {
    std::printf("skipped: this kernel runs no %s; ./dev test --arm64 sees to that\n",
                foreign_peer().c_str());
    return kSkipped;
  }
  return 0;
}

TEST_CASE("a provider of another architecture answers small calls, large ones, and streams") {
  const auto server = start_foreign_provider();
  const auto client = entity_with_lease("client", Pairing::get().client, kLongLease);
  auto echo = client->connect<LouderEcho>({.timeout = kLongPatience}).within(kLongPatience);
  for (int i = 0; i < 200; ++i) REQUIRE(echo.echo(std::to_string(i)) == std::to_string(i));
  const auto connections = client->connector().connections();
  REQUIRE(connections.size() == 1);
  CHECK(connections.front().transport == expected_transport());
  std::vector<std::uint8_t> content(kLarge);
  std::iota(content.begin(), content.end(), std::uint8_t{0});
  CHECK(echo.echo_octets(content) == content);
  std::int32_t remainder = 0;
  CHECK(echo.divide(-17, 5, remainder) == -3);
  CHECK(remainder == -2);
  CHECK_THROWS_AS(echo.divide(1, 0, remainder), ::test::DivisionByZero);
  auto numbers = echo.count_up(500, -1);
  for (std::int32_t i = 0; i < 500; ++i) REQUIRE(numbers.next() == i);
  CHECK_FALSE(numbers.next());
}

TEST_CASE("a client of another architecture is answered") {
  const auto server = entity_with_lease("server", Pairing::get().server, kLongLease);
  server->provide<LouderEcho>(std::make_shared<EchoService>());
  auto client = start_foreign_client();
  client.send("echo 200 hello");
  client.expect("echoed", kLongPatience);
  client.send("octets " + std::to_string(kLarge) + " abc");
  client.expect("echoed", kLongPatience);
  client.send("listen");
  client.expect("listens", kLongPatience);
}

TEST_CASE("the death of a provider of another architecture is noticed long before its lease") {
  auto server = start_foreign_provider();
  const auto client = entity_with_lease("client", Pairing::get().client, kLongLease);
  auto echo = client->connect<LouderEcho>({.timeout = kLongPatience});
  auto call = echo.within(10min).async_wait(600'000);
  REQUIRE(eventually([&] { return server.ask("calls", kLongPatience) == "calls 1"; }));
  server.signal(SIGKILL);
  REQUIRE(eventually([&] { return call.ready(); }));
  CHECK_THROWS_AS(call.get(), Disconnected);
  CHECK(nobody_provides(*client));
}

TEST_CASE("the death of its provider is noticed by a client of another architecture") {
  auto server = start("faults_peer", "server", *Pairing::get().server);
  server.send("provide");
  server.expect("provided");
  auto client = start_foreign_client();
  client.send("wait");
  client.expect("waiting", kLongPatience);
  REQUIRE(eventually([&] { return server.ask("calls") == "calls 1"; }));
  server.signal(SIGKILL);
  CHECK_THAT(client.ask("outcome"), Catch::StartsWith("error Disconnected"));
  CHECK(eventually([&] { return services_of(client) == 0; }));
}

TEST_CASE("the death of a client of another architecture ends its calls, over DDS by its lease") {
  constexpr std::chrono::milliseconds kLease{2000};
  const auto server = entity_with_lease("server", Pairing::get().server, kLease);
  const auto service = std::make_shared<EchoService>();
  server->provide<LouderEcho>(service);
  auto client = start_foreign_client(kLease);
  client.send("wait");
  client.expect("waiting", kLongPatience);
  REQUIRE(eventually([&] { return service->inside == 1; }));
  client.signal(SIGKILL);
  CHECK(eventually([&] { return service->inside == 0; }));
  CHECK(service->saw_cancellation);
}
