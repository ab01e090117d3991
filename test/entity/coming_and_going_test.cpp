#include <catch2/catch.hpp>

#include "office.hpp"
#include "test/tools/invariant.hpp"

using namespace skein;
using namespace skein::test;
using namespace std::chrono_literals;
using Lines = std::vector<std::string>;

TEST_CASE_METHOD(
    Office,
    "a CSP that joins while the system runs is selected from then on, and no more once it has "
    "left",
    "[wire]") {
  const Place place = GENERATE(Place::Inside, Place::Outside);
  add("old", Place::Inside, answer_as("old"), declared("10", "0.5"));
  CHECK(perform(Office::task(), 10s) == "old did it");
  add("new", place, answer_as("new"), declared("10", "0.9"));
  CHECK(perform(Office::task(), 10s) == "new did it");
  remove("new");
  REQUIRE(eventually([&] { return !knows("new"); }));
  CHECK(perform(Office::task(), 10s) == "old did it");
  CHECK(attempts() == Lines{"old accepted"});
}

TEST_CASE_METHOD(Office, "a CSP that leaves while it works is followed by the next best",
                 "[wire]") {
  // It holds its worker for as long as its owner's patience with stuck calls, no longer.
  Hang hang;
  const auto leaver = add("leaver", Place::Outside, hang.script(), declared("20", "0.9"));
  add("stayer", Place::Inside, answer_as("stayer"), declared("10", "0.5"));
  std::string result;
  std::thread other([&] { result = perform(Office::task(), 60s); });
  const bool entered = eventually([&] { return leaver->inside == 1; });
  std::thread leaving([&] { remove("leaver"); });
  other.join();
  hang.release();
  leaving.join();
  REQUIRE(entered);
  CHECK(result == "stayer did it");
  CHECK(attempts() == Lines{"leaver disconnected", "stayer accepted"});
}

TEST_CASE_METHOD(Office, "two CSPs take turns under load and no task is lost", "[wire]") {
  const Place place = GENERATE(Place::Inside, Place::Outside);
  const auto execution = GENERATE(Execution::One, Execution::Staggered, Execution::All);
  WorkTask task = Office::task();
  task.run = [](crew::Worker::Proxy& worker, Duration) { return worker.async_work("x"); };
  task.execution = execution;
  add("even", place, answer_as("even"), declared("10", "0.9"));
  std::atomic<bool> done = false;
  std::atomic<int> right = 0, wrong = 0, refused = 0;
  std::thread client([&] {
    while (!done) {
      try {
        const std::string result = owner->head().perform(task, nullptr, 30s);
        ++(result.ends_with(" did x") ? right : wrong);
      } catch (const Error&) {
        ++refused;
      }
    }
  });
  std::string here = "even", next = "odd";
  for (int round = 0; round < 8; ++round) {
    const auto worker = add(next, place, answer_as(next), declared("10", "0.9"));
    remove(here);
    CHECK(eventually([&] { return worker->calls > 0; }));
    std::swap(here, next);
  }
  done = true;
  client.join();
  INVARIANT(wrong == 0);
  CHECK(refused == 0);
  CHECK(right >= 8);
}
