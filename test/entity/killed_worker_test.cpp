#include <catch2/catch.hpp>
#include <csignal>
#include <future>
#include <thread>

#include "office.hpp"
#include "test/tools/child_process.hpp"
#include "test/tools/places.hpp"

using namespace skein;
using namespace skein::test;
using namespace std::chrono_literals;
using Lines = std::vector<std::string>;

namespace {

ChildProcess start_worker(const Office& office, const std::string& then) {
  ChildProcess worker(
      built_program("worker_process"),
      {.arguments = {Pairing::get().client->name(), "only", office.owner->id(), then}});
  worker.expect("ready");
  REQUIRE(eventually([&] { return office.is_available("only"); }));
  return worker;
}

}  // namespace

TEST_CASE("a request whose only CSP is killed is answered by it once that is there again") {
  Office office;
  auto worker = start_worker(office, "");
  auto result = std::async(std::launch::async, [&] { return office.perform(Office::task(), 60s); });
  worker.expect("inside");
  worker.signal(SIGKILL);
  REQUIRE(eventually([&] { return !office.is_available("only"); }));
  const auto restarted = start_worker(office, "answers");
  CHECK(result.get() == "only did it");
  CHECK(office.attempts() == Lines{"only disconnected", "only accepted"});
}

TEST_CASE("a request at which its CSP dies is given to that twice, and not again") {
  Office office;
  std::vector<ChildProcess> lives;
  lives.push_back(start_worker(office, "dies"));
  auto result = std::async(std::launch::async, [&] { return office.perform(Office::task(), 60s); });
  for (const char* const then : {"dies", "answers"}) {
    lives.back().expect("inside");
    REQUIRE(eventually([&] { return !office.is_available("only"); }));
    lives.push_back(start_worker(office, then));
  }
  CHECK_THROWS_WITH(result.get(), Catch::StartsWith("CSP 'only' was lost at this request twice"));
  CHECK(office.attempts() == Lines{"only disconnected", "only disconnected"});
  CHECK(office.perform(Office::task(), 60s) == "only did it");
}

TEST_CASE("where the only CSP died and is not back in time, its owner is told so") {
  Office office;
  const auto worker = start_worker(office, "dies");
  for (const auto limit : {500ms, 10ms}) {
    CHECK_THROWS_WITH(office.perform(Office::task(), limit),
                      Catch::Contains("'only' died with its process") &&
                          Catch::Contains("is not back") && !Catch::Contains("managed interface"));
  }
  CHECK_THROWS_AS(office.perform(Office::task(), 10ms), NoCandidate);
}

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
