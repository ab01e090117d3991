#include <catch2/catch.hpp>

#include "brokerless_discovery/broker.hpp"
#include "echo_service.hpp"
#include "many_clients.hpp"
#include "pairing.hpp"
#include "skein/introspection.idl.hpp"
#include "test/tools/eventually.hpp"
#include "test/tools/invariant.hpp"

using namespace skein;
using namespace skein::test;
using namespace std::chrono_literals;
using ::test::Echo;
using ::test::LouderEcho;

namespace {

/// Has room for nothing.
struct FullEcho : EchoService {
  std::string who(std::uint32_t) override {
    ++calls;
    throw Overloaded("not now");
  }
};

}  // namespace

TEST_CASE("calls that all providers refuse are repeated no more than the budget allows", "[wire]") {
  const auto process = GENERATE(false, true) ? std::make_shared<Process>() : nullptr;
  const auto service = std::make_shared<FullEcho>();
  const auto first = make_entity("first", Pairing::get().server, "uav-1", process);
  const auto second = make_entity("second", Pairing::get().server, "uav-1", process);
  first->provide<LouderEcho>(service);
  second->provide<LouderEcho>(service);
  const auto client = make_entity("client", Pairing::get().client, "uav-1", process);
  auto& broker = client->broker();
  REQUIRE(eventually([&] { return broker.find_service(broker.query("test::Echo")).size() == 2; }));
  auto echo = client->connect<Echo>().within(10min);
  for (int i = 0; i < 80; ++i) {
    CHECK_THROWS_AS(echo.who(0), Overloaded);
    CHECK_THROWS_AS(echo.async_who(0).get(), Overloaded);
  }
  CHECK(service->calls == 160 + 14);  // 5 from the start, then one for 16 calls
}

namespace {

/// A provider that takes some time for each call, on few threads.
struct Slow {
  Slow(const std::string& name, std::shared_ptr<Process> process)
      : entity(make_trusted(name, Pairing::get().server, std::move(process))) {
    entity->provide<LouderEcho>(std::make_shared<EchoService>(name), {.threads = 4});
  }

  /// Those that it has got, executed or not.
  std::uint64_t requests() const {
    std::uint64_t count = 0;
    for (const auto& service : entity->statistics()) {
      for (const auto& operation : service.operations) count += operation.received;
    }
    return count;
  }

  std::unique_ptr<Entity> entity;
};

/// One of the two providers of 32 clients dies.
void storm(const std::shared_ptr<Process>& process) {
  Slow first("first", process);
  Slow second("second", process);
  // Each has four calls done in a millisecond and more: 32 callers wait for longer than they want
  // to, so that all would hedge.
  ManyClients clients({.hedge_after = 3ms}, process, [](Echo::Proxy& echo, int) { echo.who(1); });
  CHECK(eventually([&] { return clients.calls() > 5'000; }, 60s));
  std::uint64_t requests = first.requests();
  first.entity.reset();
  const std::uint64_t before = clients.calls();
  CHECK(eventually([&] { return clients.calls() > before + 3'000; }, 60s));
  clients.stop();
  requests += second.requests();
  CAPTURE(clients.first_error(), requests, clients.calls());
  CHECK(requests > clients.calls());
  CHECK(requests <= clients.calls() + clients.calls() / 10);
  INVARIANT(clients.errors() == 0);
}

}  // namespace

TEST_CASE(
    "hedges and repeats add no more than a tenth to the load when one of two providers of 32 "
    "clients dies",
    "[wire]") {
  storm(nullptr);
}

TEST_CASE("within a process, too, hedges and repeats add no more than a tenth to the load") {
  storm(std::make_shared<Process>());
}
