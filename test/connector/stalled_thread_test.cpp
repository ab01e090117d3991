#include <atomic>
#include <catch2/catch.hpp>

#include "echo_service.hpp"
#include "pairing.hpp"
#include "skein/process.hpp"
#include "test/tools/eventually.hpp"
#include "test/tools/log.hpp"

using namespace skein;
using namespace skein::test;
using namespace std::chrono_literals;

TEST_CASE("of threads of an entity that are held up the log tells within seconds", "[wire]") {
  const auto server = make_server();
  server->provide<::test::Echo>(std::make_shared<EchoService>());
  const Log log;
  std::atomic<bool> may_return = false;
  const auto hold_up = [&] { eventually([&] { return may_return.load(); }); };
  {
    const auto client = make_client();
    auto echo = client->connect<::test::Echo>();
    client->check_progress([&](const std::string&) { hold_up(); });
    echo.async_echo("x").then([&](Call<std::string>) { hold_up(); });
    SystemClock clock;  // not the entity's, so that this timer holds up nothing else
    clock.call_after(0s, hold_up);
    for (const char* thread : {"skein-control", "skein-continue", "skein-timer"}) {
      CAPTURE(thread, log.text());
      CHECK(eventually(
          [&] { return log.count("watchdog: '" + std::string(thread) + "' has been ") == 1; }));
    }
    may_return = true;
  }
}
