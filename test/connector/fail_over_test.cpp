#include <catch2/catch.hpp>

#include "../tools/eventually.hpp"
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

}  // namespace

TEST_CASE("when a provider leaves the next call goes to the next one") {
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

TEST_CASE("a call on its way when its provider leaves ends, and not by its deadline") {
  auto server = make_server();
  const auto service = std::make_shared<EchoService>();
  const Guid id = server->provide<LouderEcho>(service);
  const auto client = make_client();
  auto echo = client->connect<Echo>();
  auto call = echo.within(10min).async_wait(200);
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
