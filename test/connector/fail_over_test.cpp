#include <catch2/catch.hpp>
#include <thread>

#include "../tools/eventually.hpp"
#include "brokerless_discovery/broker.hpp"
#include "echo_service.hpp"
#include "pairing.hpp"

using namespace skein;
using namespace skein::test;
using namespace std::chrono_literals;
using ::test::Echo;
using ::test::LouderEcho;

namespace {

struct NamedEcho : EchoService {
  explicit NamedEcho(std::string name) : name_(std::move(name)) {}
  std::string echo(const std::string&) override { return name_; }

 private:
  std::string name_;
};

/// Refuses the first so many calls.
struct RefusingEcho : EchoService {
  using EchoService::EchoService;
  std::string who(std::uint32_t time_ms) override {
    if (--refusals >= 0) throw Overloaded("not now");
    return EchoService::who(time_ms);
  }
  void fail(const std::string& how) override {
    ++failed;
    EchoService::fail(how);
  }
  std::atomic<int> refusals{1};
  std::atomic<int> failed{0};
};

/// Does not answer while it is provided.
struct EndlessEcho : EchoService {
  using EchoService::EchoService;
  std::string who(std::uint32_t) override { return EchoService::who(600'000); }
};

/// Two providers, the first of which is asked first, and a client connected to it.
template <class First>
struct Trio {
  Trio() {
    first_id = first->provide<LouderEcho>(first_service);
    second->provide<LouderEcho>(second_service);
    REQUIRE(eventually([&] { return known() == 2; }));
    echo.emplace(client->connect<Echo>());
  }
  std::size_t known() const {
    return client->broker().find_service(client->broker().query("test::Echo")).size();
  }

  std::unique_ptr<Entity> first = make_server("first");
  std::unique_ptr<Entity> second = make_server("second");
  std::shared_ptr<First> first_service = std::make_shared<First>("first");
  std::shared_ptr<EchoService> second_service = std::make_shared<EchoService>("second");
  std::unique_ptr<Entity> client = make_client();
  Guid first_id;
  std::optional<Echo::Proxy> echo;
};

}  // namespace

TEST_CASE("when a provider leaves the next call goes to the next one", "[wire]") {
  auto first = make_server("first");
  const auto second = make_server("second");
  first->provide<LouderEcho>(std::make_shared<NamedEcho>("first"));
  second->provide<LouderEcho>(std::make_shared<NamedEcho>("second"));
  const auto client = make_client();
  REQUIRE(eventually([&] {
    return client->broker().find_service(client->broker().query("test::Echo")).size() == 2;
  }));
  auto echo = client->connect<Echo>();
  CHECK(echo.echo("") == "first");
  first.reset();
  CHECK(eventually([&] { return echo.within(5s).async_echo("").get() == "second"; }));
  CHECK(echo.echo("") == "second");
}

TEST_CASE("a call on its way when its provider leaves ends, and not by its deadline", "[wire]") {
  auto server = make_server();
  const auto service = std::make_shared<EchoService>();
  const Guid id = server->provide<LouderEcho>(service);
  const auto client = make_client();
  auto echo = client->connect<Echo>();
  auto call = echo.within(10min).async_wait(600'000);
  REQUIRE(eventually([&] { return service->inside == 1; }));
  server->withdraw(id);
  CHECK_THROWS_AS(call.get(), Disconnected);
}

TEST_CASE("with no provider left a call says so") {
  auto server = make_server();
  server->provide<LouderEcho>(std::make_shared<EchoService>());
  const auto client = make_client();
  auto echo = client->connect<Echo>();
  server.reset();
  REQUIRE(eventually([&] { return client->broker().all().empty(); }));
  CHECK_THROWS_AS(echo.within(100ms).echo("x"), Unavailable);
}

TEST_CASE("an idempotent call on its way when its provider leaves is answered by the next one",
          "[wire]") {
  Trio<EndlessEcho> trio;
  SECTION("its caller waits") {
    std::string answer;
    std::thread caller([&] { answer = trio.echo->within(10min).who(0); });
    CHECK(eventually([&] { return trio.first_service->inside == 1; }));
    trio.first->withdraw(trio.first_id);
    caller.join();
    CHECK(answer == "second");
  }
  SECTION("its caller does not wait") {
    auto call = trio.echo->within(10min).async_who(0);
    REQUIRE(eventually([&] { return trio.first_service->inside == 1; }));
    trio.first->withdraw(trio.first_id);
    CHECK(call.get() == "second");
  }
  CHECK(trio.second_service->calls == 1);
}

TEST_CASE(
    "an idempotent call that is refused as Overloaded is answered by the next provider, and the "
    "connection stays") {
  Trio<RefusingEcho> trio;
  SECTION("its caller waits") { CHECK(trio.echo->who(0) == "second"); }
  SECTION("its caller does not wait") { CHECK(trio.echo->async_who(0).get() == "second"); }
  CHECK(trio.echo->who(0) == "first");
}

TEST_CASE("a call that is not idempotent is never made twice") {
  Trio<RefusingEcho> trio;
  CHECK_THROWS_AS(trio.echo->fail("overloaded"), Overloaded);
  CHECK_THROWS_AS(trio.echo->async_fail("overloaded").get(), Overloaded);
  CHECK(trio.first_service->failed == 2);
  CHECK(trio.second_service->calls == 0);
}

TEST_CASE("with nobody else to ask an idempotent call ends with what its provider said") {
  const auto server = make_server();
  const auto service = std::make_shared<RefusingEcho>();
  server->provide<LouderEcho>(service);
  const auto client = make_client();
  auto echo = client->connect<Echo>();
  service->refusals = 2;
  CHECK_THROWS_WITH(echo.within(10min).who(0), Catch::Contains("not now"));
  CHECK_THROWS_WITH(echo.within(10min).async_who(0).get(), Catch::Contains("not now"));
  CHECK(echo.who(0) == "echo");
}

TEST_CASE("dropping an idempotent call cancels it at the provider to which it moved") {
  Trio<RefusingEcho> trio;
  {
    const auto dropped = trio.echo->within(10min).async_who(600'000);
    REQUIRE(eventually([&] { return trio.second_service->inside == 1; }));
  }
  CHECK(eventually([&] { return trio.second_service->saw_cancellation.load(); }));
}
