#include <array>
#include <atomic>
#include <catch2/catch.hpp>
#include <future>
#include <thread>

#include "brokerless_discovery/broker.hpp"
#include "echo_service.hpp"
#include "many_clients.hpp"
#include "pairing.hpp"
#include "skein/head.hpp"
#include "skein/loopback.hpp"
#include "test/tools/eventually.hpp"
#include "test/tools/invariant.hpp"

using namespace skein;
using namespace skein::test;
using namespace std::chrono_literals;
using ::test::Echo;
using ::test::LouderEcho;

namespace {

/// Whose calls to wait() run until the test lets them go.
class HeldEcho : public EchoService {
 public:
  explicit HeldEcho(std::string name) : EchoService(std::move(name)) {}
  bool wait(std::uint32_t) override {
    ++inside;
    while (!release && !CallContext::current()->cancelled()) std::this_thread::yield();
    --inside;
    return release;
  }
  std::string who(std::uint32_t) override { return "first"; }
  std::atomic<bool> release{false};
};

/// A provider that is about to be drained, and a client: of another entity, or of the same process.
struct Leaving {
  explicit Leaving(bool same_process_ = false)
      : same_process(same_process_), first(make_server("first")), client(make_client()) {
    first->provide<LouderEcho>(service, {.threads = 4});
    echo.emplace(asker().connect<Echo>());
  }

  Entity& asker() { return same_process ? *first : *client; }

  void start_second() {
    second = make_server("second");
    second->provide<LouderEcho>(other, {.threads = 4});
  }

  /// Another provider, which the client knows.
  void add_second() {
    start_second();
    REQUIRE(eventually([&] {
      auto& broker = asker().broker();
      return broker.find_service(broker.query("second")).size() == 1;
    }));
  }

  void drain(Duration patience = 10min) {
    drained = std::async(std::launch::async, [this, patience] { return first->drain(patience); });
    auto& broker = asker().broker();
    REQUIRE(eventually([&] { return broker.find_service(broker.query("first")).empty(); }));
  }

  bool same_process;
  std::shared_ptr<HeldEcho> service = std::make_shared<HeldEcho>("first");
  std::shared_ptr<EchoService> other = std::make_shared<EchoService>("second");
  std::unique_ptr<Entity> first;
  std::unique_ptr<Entity> second;
  std::unique_ptr<Entity> client;
  std::optional<Echo::Proxy> echo;
  std::future<bool> drained;
};

}  // namespace

TEST_CASE("a provider that is drained finishes what it accepted, and new calls go elsewhere",
          "[wire]") {
  Leaving leaving(GENERATE(false, true));
  leaving.add_second();
  auto accepted = leaving.echo->within(10min).async_wait(0);
  REQUIRE(eventually([&] { return leaving.service->inside == 1; }));
  leaving.drain();
  CHECK(eventually([&] { return leaving.echo->who(0) == "second"; }));
  leaving.echo->note("whatever it does");
  CHECK(eventually([&] { return leaving.echo->noted() == 1; }));
  CHECK(leaving.drained.wait_for(0s) == std::future_status::timeout);
  CHECK_FALSE(accepted.ready());
  leaving.service->release = true;
  CHECK(accepted.get());
  CHECK(leaving.drained.get());
}

TEST_CASE("a provider that nobody calls is drained as soon as its clients have left it", "[wire]") {
  Leaving leaving(GENERATE(false, true));
  leaving.drain();
  CHECK(leaving.drained.get());
}

TEST_CASE("a provider that is drained executes the oneway calls that were sent before", "[wire]") {
  Leaving leaving(GENERATE(false, true));
  for (int i = 0; i < 100; ++i) leaving.echo->note("whatever it does");
  leaving.drain();
  CHECK(leaving.drained.get());
  CHECK(leaving.service->noted() == 100);
}

TEST_CASE("who looks for a provider that is drained finds none, and hears why") {
  Leaving leaving;
  auto accepted = leaving.echo->within(10min).async_wait(0);
  REQUIRE(eventually([&] { return leaving.service->inside == 1; }));
  leaving.drain();
  CHECK_THROWS_WITH(leaving.client->connect<Echo>({.timeout = 10ms}),
                    Catch::Contains("first (uav-1) is about to leave"));
  leaving.service->release = true;
  CHECK(accepted.get());
}

TEST_CASE("calls wait for the provider that takes the place of one that is drained", "[wire]") {
  Leaving leaving(GENERATE(false, true));
  leaving.drain();
  CHECK(leaving.drained.get());
  auto echo = leaving.echo->within(10min);
  auto asynchronous = echo.async_echo("not idempotent");
  auto idempotent = echo.async_who(0);
  std::thread successor([&] { leaving.start_second(); });
  CHECK(echo.echo("blocking") == "blocking");
  CHECK(asynchronous.get() == "not idempotent");
  CHECK(idempotent.get() == "second");
  successor.join();
}

TEST_CASE("what has not ended when the patience is over is withdrawn") {
  const auto clock = std::make_shared<ManualClock>();
  dds::LoopbackNetwork network(*clock);
  const auto join = [&](const std::string& name) {
    return make_entity(name, network.vendor(), "uav-1", std::make_shared<Process>(clock));
  };
  const auto server = join("server");
  const auto client = join("client");
  const auto service = std::make_shared<HeldEcho>("server");
  server->provide<LouderEcho>(service);
  auto echo = client->connect<Echo>();
  auto call = echo.within(10min).async_wait(0);
  REQUIRE(eventually([&] { return service->inside == 1; }));
  auto drained = std::async(std::launch::async, [&] { return server->drain(3s); });
  CHECK(eventually(
      [&] { return client->broker().find_service(client->broker().query("server")).empty(); }));
  CHECK(drained.wait_for(0s) == std::future_status::timeout);
  clock->advance(3s);
  CHECK_FALSE(drained.get());
  CHECK_THROWS_AS(call.get(), Disconnected);
}

namespace {

/// Calls a CSP of its own entity once the test lets it.
class Asking : public EchoService {
 public:
  Asking(Entity& entity) : entity_(entity) {}
  std::string echo(const std::string& text) override {
    ++inside;
    while (!release) std::this_thread::yield();
    Task<::test::Echo, std::string> task;
    task.run = [&](Echo::Proxy& csp, Duration) { return csp.async_echo(text); };
    return entity_.head().perform(task);
  }
  std::atomic<bool> release{false};

 private:
  Entity& entity_;
};

}  // namespace

TEST_CASE("a Body that is drained has its CSPs until it is idle") {
  auto server = make_server();
  server->provide_csp<Echo>("Csp", server->id(), std::make_shared<EchoService>("csp"));
  const auto body = std::make_shared<Asking>(*server);
  server->provide<LouderEcho>(body);
  const auto client = make_client();
  auto call = client->connect<Echo>({.name = "server"}).within(10min).async_echo("by a CSP");
  REQUIRE(eventually([&] { return body->inside == 1; }));
  auto drained = std::async(std::launch::async, [&] { return server->drain(10min); });
  auto& broker = client->broker();
  CHECK(eventually([&] { return broker.find_service(broker.query("server")).empty(); }));
  body->release = true;
  CHECK(call.get() == "by a CSP");
  CHECK(drained.get());
}

namespace {

/// A provider that can be started again. Counts what all its lives have executed.
class Restarted {
 public:
  Restarted(const std::string& name, std::shared_ptr<Process> process)
      : name_(name), process_(std::move(process)) {
    start();
  }

  /// False where it had to leave calls behind.
  bool restart() {
    const bool drained = entity_->drain(20s);
    executed_ += service_->calls;
    entity_.reset();
    start();
    return drained;
  }
  std::uint64_t executed() const { return executed_ + service_->calls; }

 private:
  void start() {
    entity_ = make_trusted(name_, Pairing::get().server, process_);
    service_ = std::make_shared<EchoService>(name_);
    entity_->provide<LouderEcho>(service_, {.threads = 2});
  }

  const std::string name_;
  const std::shared_ptr<Process> process_;
  std::unique_ptr<Entity> entity_;
  std::shared_ptr<EchoService> service_;
  std::uint64_t executed_ = 0;
};

/// Restarts both providers of 32 clients one after the other, so many times.
void roll(int rounds, const std::shared_ptr<Process>& process) {
  std::array<Restarted, 2> providers{Restarted("first", process), Restarted("second", process)};
  // Not idempotent, so that none may run twice: of callers that wait, and that do not.
  ManyClients clients({}, process, [](Echo::Proxy& echo, int number) {
    const std::string text = number % 2 ? echo.echo("x") : echo.async_echo("x").get();
    if (text != "x") throw std::runtime_error("the wrong answer: " + text);
  });
  for (int round = 0; round < rounds; ++round) {
    for (Restarted& provider : providers) {
      const std::uint64_t before = clients.calls();
      CHECK(eventually([&] { return clients.calls() > before + 200; }));
      CHECK(provider.restart());
    }
  }
  clients.stop();
  CAPTURE(clients.first_error(), clients.calls());
  INVARIANT(clients.errors() == 0);
  INVARIANT(providers[0].executed() + providers[1].executed() == clients.calls());
}

}  // namespace

TEST_CASE("a rolling restart of all providers costs 32 clients no call", "[wire]") {
  roll(2, GENERATE(false, true) ? std::make_shared<Process>() : nullptr);
}

TEST_CASE("rolling restarts, one after the other, cost 32 clients no call", "[long]") {
  roll(20, GENERATE(false, true) ? std::make_shared<Process>() : nullptr);
}
