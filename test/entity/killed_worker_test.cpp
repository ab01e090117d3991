#include <catch2/catch.hpp>
#include <csignal>
#include <thread>

#include "office.hpp"
#include "test/tools/child_process.hpp"
#include "test/tools/places.hpp"

using namespace skein;
using namespace skein::test;
using namespace std::chrono_literals;
using Lines = std::vector<std::string>;

TEST_CASE("a CSP that is killed while it works is followed by the next best") {
  Office office;
  office.add("survivor", Place::Inside, answer_as("survivor"), declared("10", "0.5"));
  ChildProcess victim(built_program("worker_process"),
                      {.arguments = {Pairing::get().client->name(), "victim", office.owner->id()}});
  victim.expect("ready");
  REQUIRE(eventually([&] { return office.is_available("victim"); }));

  std::string result;
  std::thread other([&] { result = office.perform(Office::task(), 60s); });
  victim.expect("inside");
  const auto running = office.owner->head().running();
  victim.signal(SIGKILL);
  other.join();
  CHECK(result == "survivor did it");
  CHECK(office.attempts() == Lines{"victim disconnected", "survivor accepted"});
  REQUIRE(running.size() == 1);
  CHECK(running[0].pid == static_cast<std::uint32_t>(victim.pid()));

  SECTION("and is gone from the candidates") {
    CHECK(office.perform(Office::task(), 10s) == "survivor did it");
    CHECK(office.attempts() == Lines{"survivor accepted"});
  }
}
