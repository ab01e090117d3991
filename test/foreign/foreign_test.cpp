#include <catch2/catch.hpp>
#include <cstdlib>
#include <thread>

#include "lookout_service.hpp"
#include "test/connector/pairing.hpp"
#include "test/tools/child_process.hpp"
#include "test/tools/eventually.hpp"

using namespace skein;
using namespace skein::test;
using namespace std::chrono_literals;
using foreign::ILookout;

namespace {

ChildProcess start_client(const std::string& name, int calls) {
  return {std::getenv("FOREIGN_CLIENT"), {.arguments = {name, std::to_string(calls)}}};
}

/// What a foreign client prints, whose oneway call was the only one or one of several.
std::string expected(int calls, const std::string& remembered) {
  return "unknown operation: 4\n"
         "look: kind 1, Anna at 90.5, 3 bytes, turns 4, clear\n"
         "look: OutOfSight 5000 beyond the horizon\n"
         "look: Asleep\n"
         "echo: " +
         std::to_string(calls) +
         " right\n"
         "overload: remote exception 3\n"
         "reject: remote exception 2\n"
         "break: remote exception 5\n"
         "remembered: " +
         remembered +
         "\n"
         "place: mast\n";
}

/// A server that is not built with Skein, and a Skein client of it.
struct ForeignServer {
  ForeignServer() : lookout(connect(*client)) {}

  static ILookout::Proxy connect(Entity& entity) {
    return entity.connect<ILookout>({.timeout = 20s, .foreign = true});
  }

  ChildProcess program{std::getenv("FOREIGN_SERVER"), {}};
  std::unique_ptr<Entity> client = make_client();
  ILookout::Proxy lookout;
};

}  // namespace

TEST_CASE("a peer without Skein calls a Skein service") {
  const auto server = make_server();
  const auto service = std::make_shared<LookoutService>();
  server->provide<ILookout>(service);
  ChildProcess client = start_client("solo", 100);
  CHECK(client.read_all() == expected(100, "1"));
  CHECK(client.finish() == 0);
  CHECK(service->echoes == 103);
}

TEST_CASE("several peers without Skein at once get each its own replies") {
  constexpr int kClients = 4;
  constexpr int kCalls = 200;
  const auto server = make_server();
  const auto service = std::make_shared<LookoutService>();
  server->provide<ILookout>(service);
  std::vector<ChildProcess> clients;
  for (int i = 0; i < kClients; ++i)
    clients.push_back(start_client("client " + std::to_string(i), kCalls));
  for (ChildProcess& client : clients) {
    const std::string text = client.read_all();
    const std::string alike = expected(kCalls, "");
    const auto counted = alike.find("remembered: ") + 12;
    CHECK(text.substr(0, counted) == alike.substr(0, counted));
    CHECK(client.finish() == 0);
  }
  CHECK(service->echoes == kClients * (kCalls + 3));
  CHECK(service->remembered() == kClients);
}

TEST_CASE("a Skein client and one without Skein share a service") {
  const auto server = make_server();
  server->provide<ILookout>(std::make_shared<LookoutService>());
  const auto entity = make_client();
  auto lookout = entity->connect<ILookout>({.timeout = 20s});
  ChildProcess client = start_client("other", 200);
  for (int i = 0; i < 200; ++i)
    CHECK(lookout.echo("mine " + std::to_string(i)) == "mine " + std::to_string(i));
  CHECK(client.read_all() == expected(200, "1"));
}

TEST_CASE("a peer without Skein serves a Skein client") {
  ForeignServer foreign;
  std::int16_t turns = 3;
  std::string remark;
  const foreign::Sighting sighting = foreign.lookout.look(90.5, 4000, turns, remark);
  CHECK(sighting == foreign::Sighting{foreign::Kind::Ship, "Anna", 90.5, {1, 2, 3}});
  CHECK(turns == 4);
  CHECK(remark == "clear");
  CHECK(foreign.lookout.place() == "mast");
}

TEST_CASE("the exceptions of a server without Skein arrive as their own types") {
  ForeignServer foreign;
  std::int16_t turns = 3;
  std::string remark;
  try {
    foreign.lookout.look(0, 10'000'000'000, turns, remark);
    FAIL("no exception");
  } catch (const foreign::OutOfSight& exception) {
    CHECK(exception == foreign::OutOfSight(5000, "beyond the horizon"));
  }
  turns = -1;
  CHECK_THROWS_AS(foreign.lookout.look(0, 4000, turns, remark), foreign::Asleep);
}

TEST_CASE("the remote exceptions of a server without Skein arrive as errors of their class") {
  ForeignServer foreign;
  CHECK_THROWS_AS(foreign.lookout.echo("overload"), Overloaded);
  CHECK_THROWS_AS(foreign.lookout.echo("reject"), InvalidArgument);
  CHECK_THROWS_AS(foreign.lookout.echo("break"), Internal);
  CHECK(foreign.lookout.echo("and on") == "and on");
}

TEST_CASE("an operation that a server without Skein does not know is Unimplemented") {
  ForeignServer foreign;
  auto newer = foreign.client->connect<later::ILookout>(
      {.name = "foreign::ILookout", .timeout = 20s, .foreign = true});
  CHECK(newer.echo("known") == "known");
  CHECK_THROWS_AS(newer.wake("Anna"), Unimplemented);
}

TEST_CASE("oneway calls reach a server without Skein, each once") {
  ForeignServer foreign;
  for (int i = 0; i < 20; ++i) foreign.lookout.remember("this");
  CHECK(eventually([&] { return foreign.lookout.remembered() == 20; }));
}

TEST_CASE("several Skein clients of one server without Skein get each its own replies") {
  ForeignServer foreign;
  std::vector<std::thread> callers;
  std::atomic<int> right = 0;
  for (int caller = 0; caller < 3; ++caller) {
    callers.emplace_back([&, caller] {
      const auto entity = make_client("caller" + std::to_string(caller));
      auto lookout = ForeignServer::connect(*entity);
      for (int i = 0; i < 100; ++i) {
        const std::string text = std::to_string(caller) + ":" + std::to_string(i);
        right += lookout.echo(text) == text;
      }
    });
  }
  for (std::thread& caller : callers) caller.join();
  CHECK(right == 300);
}

TEST_CASE("a call that a server without Skein does not answer ends at its deadline") {
  ForeignServer foreign;
  CHECK_THROWS_AS(foreign.lookout.within(100ms).echo("silence"), TimedOut);
  CHECK(foreign.lookout.echo("and on") == "and on");
}

TEST_CASE("when a server without Skein leaves, the pending call ends as Disconnected") {
  ForeignServer foreign;
  auto call = foreign.lookout.within(60s).async_echo("silence");
  CHECK(foreign.program.finish() == 0);
  CHECK_THROWS_AS(call.get(), Disconnected);
  CHECK_THROWS_AS(foreign.lookout.echo("gone"), Unavailable);
}

TEST_CASE("where there is no server, connecting to a foreign one ends with the reason") {
  const auto entity = make_client();
  CHECK_THROWS_WITH(entity->connect<ILookout>({.timeout = 200ms, .foreign = true}),
                    Catch::Contains("foreign server of foreign/ILookout") &&
                        Catch::Contains("no provider's endpoint was found"));
}
