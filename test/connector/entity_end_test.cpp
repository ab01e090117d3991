#include <atomic>
#include <catch2/catch.hpp>
#include <future>

#include "echo_service.hpp"
#include "pairing.hpp"
#include "skein/loopback.hpp"
#include "test/tools/eventually.hpp"

using namespace skein;
using namespace skein::test;
using namespace std::chrono_literals;
using ::test::Echo;
using ::test::LouderEcho;

namespace {

constexpr std::int32_t kEndless = 1 << 30;
constexpr std::uint32_t kLong = 600'000;  // ms

// A service and a client of it, in entities of their own: with one process in common, or over DDS.
struct Neighbours {
  explicit Neighbours(bool same_process) {
    const auto process = std::make_shared<Process>();
    const auto& vendors = Pairing::get();
    server = make_entity("server", vendors.server, "uav-1", process);
    client = same_process ? make_entity("client", vendors.server, "uav-1", process)
                          : make_entity("client", vendors.client);
    ServiceOptions options;
    options.threads = 4;
    id = server->provide<LouderEcho>(service, options);
  }

  const std::shared_ptr<EchoService> service = std::make_shared<EchoService>();
  std::unique_ptr<Entity> server;
  std::unique_ptr<Entity> client;
  Guid id;
};

}  // namespace

TEST_CASE("an entity that ends ends its calls and streams as Disconnected, and its proxies say why",
          "[wire]") {
  Neighbours neighbours(GENERATE(true, false));
  auto echo = neighbours.client->connect<Echo>().within(10min);
  auto call = echo.async_wait(kLong);
  auto numbers = echo.count_up(kEndless, -1);
  REQUIRE(numbers.next() == 0);
  bool told = false;
  echo.async_wait(kLong).then([&](Call<bool> ended) {
    CHECK_THROWS_AS(ended.get(), Disconnected);
    told = true;
  });

  neighbours.client.reset();
  CHECK(told);
  REQUIRE(call.ready());
  CHECK_THROWS_AS(call.get(), Disconnected);
  CHECK_THROWS_AS(
      [&] {
        while (numbers.next()) {
        }
      }(),
      Disconnected);
  CHECK_THROWS_AS(echo.echo("x"), Unavailable);
  CHECK_THROWS_AS(echo.async_echo("x").get(), Unavailable);
  CHECK_FALSE(echo.channel()->connected());
  bool refused = false;
  echo.async_echo("x").then([&](Call<std::string> ended) {
    CHECK_THROWS_AS(ended.get(), Unavailable);
    refused = true;
  });
  CHECK(refused);
  CHECK(eventually([&] { return neighbours.service->inside == 0; }));
}

TEST_CASE("a thread that waits for an answer is told when its entity ends", "[wire]") {
  Neighbours neighbours(false);
  auto echo = neighbours.client->connect<Echo>().within(10min);
  auto waiting = std::async(std::launch::async, [&] { return echo.wait(kLong); });
  REQUIRE(eventually([&] { return neighbours.service->inside == 1; }));
  neighbours.client.reset();
  CHECK_THROWS_AS(waiting.get(), Disconnected);
}

TEST_CASE("a call that waits for another provider ends with its entity", "[wire]") {
  Neighbours neighbours(false);
  auto echo = neighbours.client->connect<Echo>().within(10min);
  neighbours.server.reset();
  REQUIRE(eventually([&] { return !echo.channel()->connected(); }));
  auto waiting = std::async(std::launch::async, [&] { return echo.echo("x"); });
  auto call = echo.async_echo("x");
  neighbours.client.reset();
  CHECK_THROWS_AS(waiting.get(), Unavailable);
  REQUIRE(call.ready());
  CHECK_THROWS_AS(call.get(), Unavailable);
}

TEST_CASE("a connection that is being opened ends with its entity, though time stands still",
          "[wire]") {
  const auto clock = std::make_shared<ManualClock>();
  std::atomic<bool> asked = false;
  dds::LoopbackNetwork network(*clock);
  network.judge_transfers([&](const dds::Transfer& transfer) {
    if (transfer.topic.ends_with("_Request")) asked = true;
    return transfer.topic.ends_with("_Reply") ? dds::Fate::drop() : dds::Fate::deliver();
  });
  const auto join = [&](const std::string& name) {
    return make_entity(name, network.vendor(), "uav-1", std::make_shared<Process>(clock));
  };
  const auto server = join("server");
  server->provide<LouderEcho>(std::make_shared<EchoService>());
  auto client = join("client");
  auto connecting = std::async(std::launch::async, [connector = client->connector()]() mutable {
    return connector.connect<Echo>();
  });
  REQUIRE(eventually([&] { return asked.load(); }));
  client.reset();
  CHECK_THROWS_AS(connecting.get(), Unavailable);
}

TEST_CASE("calls that wait at a service that is withdrawn are refused at once", "[wire]") {
  Neighbours neighbours(true);
  auto echo = neighbours.client->connect<Echo>().within(10min);
  std::vector<Call<bool>> running;
  for (int i = 0; i < 4; ++i) running.push_back(echo.async_wait(kLong));
  REQUIRE(eventually([&] { return neighbours.service->inside == 4; }));
  auto waiting = echo.async_wait(kLong);
  neighbours.server->withdraw(neighbours.id);
  REQUIRE(waiting.ready());
  CHECK_THROWS_AS(waiting.get(), Unavailable);
  CHECK(neighbours.service->calls == 4);
}
