#include <catch2/catch.hpp>
#include <csignal>
#include <cstdio>
#include <thread>

#include "test/faults/exposed_service.hpp"
#include "test/faults/processes.hpp"

using namespace skein;
using namespace skein::test;
using namespace std::chrono_literals;
using brokerless_discovery::Change;
using brokerless_discovery::Departure;
using ::test::LouderEcho;

namespace {

/// So long that whatever is noticed in a test is noticed by other means.
constexpr std::chrono::milliseconds kLongLease{60'000};
const std::vector<std::string> kLongLeaseArgument{"lease=60000"};

bool knows(Entity& entity, std::size_t count) {
  const auto& broker = entity.broker();
  const auto query = broker.query("test::Echo");
  const bool known = eventually([&] { return broker.find_service(query).size() == count; });
  if (!known) UNSCOPED_INFO(broker.explain(query));
  return known;
}

/// For another lease a process stays stopped after the others forgot it.
constexpr auto kStopped = 1000ms;

/// Answers `shout` with much, once it may.
struct GatedEcho : EchoService {
  std::string shout(const std::string&) override {
    while (!open) std::this_thread::sleep_for(1ms);
    return std::string(256 * 1024, 'x');
  }
  std::atomic<bool> open{false};
};

}  // namespace

TEST_CASE(
    "a provider killed on the same host: its call ends as Disconnected and its description goes, "
    "long before the lease") {
  auto server = start_provider("server", *Pairing::get().server, kLongLeaseArgument);
  const auto client = entity_with_lease("client", Pairing::get().client, kLongLease);
  std::atomic<int> deaths = 0;
  std::atomic<int> others = 0;
  const auto observed = client->broker().observe([&](const Change& change) {
    if (change.kind != Change::Kind::Removed) return;
    ++(change.departure == Departure::Died ? deaths : others);
  });
  auto echo = client->connect<LouderEcho>({.timeout = 20s});
  auto call = echo.within(10min).async_wait(600'000);
  REQUIRE(eventually([&] { return server.ask("calls") == "calls 1"; }));

  const auto killed = std::chrono::steady_clock::now();
  server.signal(SIGKILL);
  REQUIRE(eventually([&] { return call.ready(); }));
  const auto took = std::chrono::steady_clock::now() - killed;
  CHECK_THROWS_AS(call.get(), Disconnected);
  CHECK(knows(*client, 0));
  CHECK(eventually([&] { return deaths == 1; }));
  CHECK(others == 0);
  CHECK(took < kLongLease);
  CHECK_THROWS_AS(echo.within(100ms).echo("x"), Unavailable);
  std::printf("killed to told, same host, %s server, %s client: %.1f ms\n",
              Pairing::get().server->name().c_str(), Pairing::get().client->name().c_str(),
              std::chrono::duration<double, std::milli>(took).count());
}

TEST_CASE("an idempotent call whose only provider is killed is answered once that is there again") {
  auto server = start_provider("server", *Pairing::get().server, kLongLeaseArgument);
  const auto client = entity_with_lease("client", Pairing::get().client, kLongLease);
  auto echo = client->connect<LouderEcho>({.timeout = 20s}).within(10min);
  server.signal(SIGSTOP);  // it gets the call, and does not answer
  auto call = echo.async_who(0);
  server.signal(SIGKILL);
  REQUIRE(knows(*client, 0));
  CHECK_FALSE(call.ready());
  auto restarted = start_provider("server", *Pairing::get().server, kLongLeaseArgument);
  CHECK(call.get() == "echo");
}

TEST_CASE(
    "a provider killed in the middle of a stream: what came can be taken, then the stream ends") {
  auto server = start_provider("server", *Pairing::get().server, kLongLeaseArgument);
  const auto client = entity_with_lease("client", Pairing::get().client, kLongLease);
  auto echo = client->connect<LouderEcho>({.timeout = 20s});
  auto numbers = echo.within(10min).count_up(1'000'000, -1);
  for (std::int32_t i = 0; i < 100; ++i) REQUIRE(numbers.next() == i);
  server.signal(SIGKILL);
  REQUIRE(eventually([&] { return !echo.channel()->connected(); }));
  std::uint32_t left = 0;
  CHECK_THROWS_AS(
      [&] {
        while (numbers.next()) ++left;
      }(),
      Disconnected);
  CHECK(left <= PendingStream::kWindow);
}

TEST_CASE("after a provider's death the next call goes to the next provider") {
  auto first = start_provider("first", *Pairing::get().server, kLongLeaseArgument);
  auto second = start_provider("second", *Pairing::get().server, kLongLeaseArgument);
  const auto client = entity_with_lease("client", Pairing::get().client, kLongLease);
  REQUIRE(knows(*client, 2));
  auto echo = client->connect<LouderEcho>({.timeout = 20s});
  CHECK(echo.within(20s).echo("x") == "x");
  CHECK(first.ask("calls") == "calls 1");
  first.signal(SIGKILL);
  REQUIRE(eventually([&] { return !echo.channel()->connected(); }));
  CHECK(echo.within(20s).echo("x") == "x");
  CHECK(second.ask("calls") == "calls 1");
}

TEST_CASE(
    "a provider that was stopped for longer than its lease is found again by itself, and answers",
    "[R17]") {
  auto server = start_provider("server", *Pairing::get().server);
  const auto client = entity_with_lease("client", Pairing::get().client, 1000ms);
  auto echo = client->connect<LouderEcho>({.timeout = 20s});
  CHECK(echo.within(20s).echo("before") == "before");
  server.signal(SIGSTOP);
  REQUIRE(knows(*client, 0));
  CHECK_THROWS_AS(echo.within(50ms).echo("meanwhile"), Error);
  let_last(kStopped);
  server.signal(SIGCONT);
  REQUIRE(knows(*client, 1));
  CHECK(echo.within(20s).echo("after") == "after");
}

TEST_CASE(
    "a client that was stopped for longer than its lease finds its provider again, and calls it") {
  const auto server = entity_with_lease("server", Pairing::get().server, 1000ms);
  ExposedService service(*server, std::make_shared<EchoService>());
  auto client = start_client("client", *Pairing::get().client);
  client.send("echo 1 before");
  client.expect("echoed");
  REQUIRE(service.counters().clients == 1);
  client.signal(SIGSTOP);
  REQUIRE(eventually([&] { return service.counters().clients == 0; }));
  let_last(kStopped);
  client.signal(SIGCONT);
  call_until_connected(client);
  CHECK(service.counters().clients == 1);
}

TEST_CASE("with a client that died its session goes, and its call learns of it") {
  const auto server = entity_with_lease("server", Pairing::get().server, 1000ms);
  const auto echo = std::make_shared<EchoService>();
  ExposedService service(*server, echo);
  auto client = start_client("client", *Pairing::get().client);
  client.send("wait");
  client.expect("waiting");
  REQUIRE(eventually([&] { return echo->inside == 1; }));
  CHECK(service.counters().clients == 1);
  CHECK(service.sessions() == 1);
  client.signal(SIGKILL);
  CHECK(eventually([&] { return echo->saw_cancellation.load(); }));
  CHECK(eventually([&] { return service.counters().clients == 0 && service.sessions() == 0; }));
  CHECK(eventually([&] { return service.counters().active == 0; }));

  auto next = start_client("client", *Pairing::get().client);
  next.send("echo 1 next");
  next.expect("echoed");
}

TEST_CASE("a client that does not read its replies holds up nobody else") {
  const auto server = entity_with_lease("server", Pairing::get().server, kLongLease);
  const auto echo = std::make_shared<GatedEcho>();
  ExposedService service(*server, echo);
  auto deaf = start_client("deaf", *Pairing::get().client, kLongLeaseArgument);
  auto good = start_client("good", *Pairing::get().client, kLongLeaseArgument);
  deaf.send("pour 200");
  deaf.expect("poured");
  REQUIRE(eventually([&] { return service.counters().active == 200; }));
  deaf.signal(SIGSTOP);
  echo->open = true;
  good.send("echo 20 x");
  good.expect("echoed");
  CHECK(eventually([&] { return service.counters().active == 0; }));
}
