#include <atomic>
#include <catch2/catch.hpp>
#include <thread>

#include "entity/entity_access.hpp"
#include "rpc/server/sessions.hpp"
#include "test/faults/exposed_service.hpp"
#include "test/faults/messages.hpp"
#include "test/faults/processes.hpp"

using namespace skein;
using namespace skein::test;
using namespace std::chrono_literals;
using ::test::LouderEcho;
namespace wire = rpc::wire;

namespace {

constexpr std::size_t kMax = rpc::Sessions::kMostOfPeer;

/// Vendors need long to make thousands of writers known.
std::size_t size_of_flood() { return Pairing::get().client->name() == "loopback" ? 3000 : 400; }

/// A rogue that opens a session by each of its many writers.
class Flood {
 public:
  Flood(Entity& entity, const calls::Address& address) {
    dds::Qos qos;
    qos.partitions = {calls::partition_of(address.provider)};
    for (std::size_t i = 0; i < size_of_flood(); ++i) {
      writers_.push_back(
          EntityAccess::participant(entity).create_writer(calls::request_topic(address), qos));
    }
  }

  /// Again and again: what is written before the other side has found a writer may be lost.
  void open_all() {
    for (const auto& writer : writers_) {
      Bytes message;
      wire::begin_request(message, {writer->guid(), 0}, wire::kOpen);
      wire::append_default_branch(message);
      wire::append_trailer(message, wire::RequestTrailer{1s, 0, {}, ""});
      writer->write(message);
    }
  }

 private:
  std::vector<std::unique_ptr<dds::Writer>> writers_;
};

/// Providers `a`, `b` and `c`, which are asked in this order, and a client that knows them.
struct Row {
  Row() {
    REQUIRE(eventually([&] {
      return client->broker().find_service(client->broker().query("test::Echo")).size() == 3;
    }));
  }
  std::string first_asked() {
    return client->connect<LouderEcho>({.timeout = 20s}).channel()->peer();
  }

  std::unique_ptr<Entity> one = entity_with_lease("a", Pairing::get().server, 1000ms);
  std::unique_ptr<Entity> two = entity_with_lease("b", Pairing::get().server, 1000ms);
  std::unique_ptr<Entity> three = entity_with_lease("c", Pairing::get().server, 1000ms);
  std::unique_ptr<ExposedService> a =
      std::make_unique<ExposedService>(*one, std::make_shared<EchoService>());
  ExposedService b{*two, std::make_shared<EchoService>()};
  ExposedService c{*three, std::make_shared<EchoService>()};
  std::unique_ptr<Entity> client = entity_with_lease("client", Pairing::get().client, 1000ms);
};

}  // namespace

TEST_CASE("a provider without room for one more session gives way to the next") {
  Row row;
  CHECK_THAT(row.first_asked(), Catch::Contains(" of a "));
  SECTION("when a connection is made") {
    row.a->fill();
    CHECK_THAT(row.first_asked(), Catch::Contains(" of b "));
    row.b.fill();
    CHECK_THAT(row.first_asked(), Catch::Contains(" of c "));
    row.c.fill();
    CHECK_THROWS_AS(row.first_asked(), Overloaded);
    CHECK_THROWS_WITH(row.first_asked(),
                      Catch::Contains(" of c ") && Catch::Contains("no room for one more session"));
  }
  SECTION("when all are connected to") {
    row.a->fill();
    row.c.fill();
    const auto all = row.client->connect_all<LouderEcho>({.timeout = 20s});
    REQUIRE(all.size() == 1);
    CHECK(all[0].entity == "b");
    row.b.fill();
    CHECK_THROWS_AS(row.client->connect_all<LouderEcho>({.timeout = 20s}), Overloaded);
  }
  SECTION("when the provider of a connection has left") {
    auto echo = row.client->connect<LouderEcho>({.timeout = 20s}).within(20s);
    row.b.fill();
    row.a.reset();
    REQUIRE(eventually([&] { return !echo.channel()->connected(); }));
    CHECK(echo.echo("x") == "x");
    CHECK_THAT(echo.channel()->peer(), Catch::Contains(" of c "));
  }
}

TEST_CASE("a peer that opens sessions without end gets its share, and others their answers") {
  const auto server = entity_with_lease("server", Pairing::get().server, 1000ms);
  const auto client = entity_with_lease("client", Pairing::get().client, 1000ms);
  const auto rogue = entity_with_lease("rogue", Pairing::get().client, 1000ms);
  ExposedService service(*server, std::make_shared<EchoService>());
  auto echo = client->connect<LouderEcho>({.timeout = 20s}).within(60s);
  Flood flood(*rogue, service.address());

  REQUIRE(eventually([&] {
    flood.open_all();
    const std::string text = std::to_string(service.counters().turned_away);
    CHECK(echo.echo(text) == text);
    CHECK(service.counters().clients <= kMax + 1);
    return service.counters().turned_away >= size_of_flood() - kMax;
  }));
  CHECK(service.sessions() <= kMax + 1);
  CHECK(echo.echo("x") == "x");
  const auto newcomer = entity_with_lease("newcomer", Pairing::get().client, 1000ms);
  CHECK(newcomer->connect<LouderEcho>({.timeout = 60s}).within(60s).echo("y") == "y");
}

TEST_CASE("a client beyond its peer's share of sessions hears why it is refused") {
  const auto server = entity_with_lease("server", Pairing::get().server, 1000ms);
  const auto client = entity_with_lease("client", Pairing::get().client, 1000ms);
  ExposedService service(*server, std::make_shared<EchoService>());
  std::vector<LouderEcho::Proxy> proxies;
  for (std::size_t i = 0; i < kMax; ++i) {
    proxies.push_back(client->connect<LouderEcho>({.timeout = 20s}));
  }
  CHECK_THROWS_WITH(client->connect<LouderEcho>({.timeout = 20s}),
                    Catch::Contains("share of sessions") && Catch::Contains("close connections"));
  proxies.pop_back();
  CHECK(eventually([&] {
    try {
      return client->connect<LouderEcho>({.timeout = 20s}).echo("x") == "x";
    } catch (const Overloaded&) {
      return false;
    }
  }));
}
