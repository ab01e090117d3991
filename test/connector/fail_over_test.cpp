#include <catch2/catch.hpp>
#include <future>
#include <thread>

#include "brokerless_discovery/broker.hpp"
#include "echo_pair.hpp"
#include "pairing.hpp"
#include "test/tools/eventually.hpp"

using namespace skein;
using namespace skein::test;
using namespace std::chrono_literals;
using ::test::Echo;
using ::test::LouderEcho;

namespace {

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

/// At first a call of its own is not sent.
struct NeedyEcho : EchoService {
  std::string echo(const std::string& text) override {
    if (++calls < 3) throw NotSent("a service that it needs has gone");
    return text;
  }
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
  Trio<EchoService> trio;
  CHECK(trio.echo->echo("x") == "x");
  CHECK(trio.first_service->calls == 1);
  trio.first.reset();
  CHECK(trio.echo->within(5s).async_echo("y").get() == "y");
  CHECK(trio.echo->echo("z") == "z");
  CHECK(trio.second_service->calls == 2);
}

TEST_CASE("a call whose implementation could not send one of its own is made once") {
  const auto entity = make_server();
  const auto service = std::make_shared<NeedyEcho>();
  entity->provide<LouderEcho>(service);
  auto echo = entity->connect<Echo>();
  CHECK_THROWS_AS(echo.echo("x"), Unavailable);
  CHECK(service->calls == 1);
}

TEST_CASE("a call on its way when its provider leaves ends, and not by its deadline", "[wire]") {
  EchoPair pair(make_server(), make_client());
  auto call = pair.echo->within(10min).async_wait(600'000);
  REQUIRE(eventually([&] { return pair.service->inside == 1; }));
  pair.server->withdraw(pair.id);
  CHECK_THROWS_AS(call.get(), Disconnected);
}

TEST_CASE("with no provider left a call says so") {
  EchoPair pair(make_server(), make_client());
  pair.server.reset();
  REQUIRE(eventually([&] { return pair.client->broker().all().empty(); }));
  CHECK_THROWS_AS(pair.echo->within(100ms).echo("x"), Unavailable);
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

TEST_CASE("an idempotent call on its way when its only provider leaves waits for the next one",
          "[wire]") {
  EchoPair<EndlessEcho> pair(make_server("first"), make_client());
  const auto started = std::make_shared<EchoService>("second");
  const auto ask = [&, asynchronous = GENERATE(true, false)] {
    auto echo = pair.echo->within(10min);
    return asynchronous ? echo.async_who(0).get() : echo.who(0);
  };
  auto answer = std::async(std::launch::async, ask);
  REQUIRE(eventually([&] { return pair.service->inside == 1; }));
  pair.server.reset();
  REQUIRE(eventually([&] { return !pair.echo->channel()->connected(); }));
  SECTION("which holds up no caller with less time") {
    CHECK_THROWS_AS(pair.echo->within(50ms).who(0), Unavailable);
    CHECK_THROWS_AS(pair.echo->within(50ms).async_who(0).get(), Unavailable);
    CHECK_THROWS_AS(pair.echo->within(50ms).async_echo("x").get(), Unavailable);
  }
  const auto second = make_server("second");
  second->provide<LouderEcho>(started);
  CHECK(answer.get() == "second");
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
  EchoPair<RefusingEcho> pair(make_server(), make_client());
  pair.service->refusals = 2;
  CHECK_THROWS_WITH(pair.echo->within(10min).who(0), Catch::Contains("not now"));
  CHECK_THROWS_WITH(pair.echo->within(10min).async_who(0).get(), Catch::Contains("not now"));
  CHECK(pair.echo->who(0) == "echo");
}

TEST_CASE("dropping an idempotent call cancels it at the provider to which it moved") {
  Trio<RefusingEcho> trio;
  {
    const auto dropped = trio.echo->within(10min).async_who(600'000);
    REQUIRE(eventually([&] { return trio.second_service->inside == 1; }));
  }
  CHECK(eventually([&] { return trio.second_service->saw_cancellation.load(); }));
}
