#include <catch2/catch.hpp>

#include "office.hpp"
#include "test/tools/log.hpp"

using namespace skein;
using namespace skein::test;
using namespace std::chrono_literals;
using Lines = std::vector<std::string>;

namespace {

/// A task that may run on several CSPs at a time.
WorkTask task_for(Execution execution, std::size_t enough = 1) {
  WorkTask task = Office::task();
  task.run = [](crew::Worker::Proxy& worker, Duration) { return worker.async_work("it"); };
  task.execution = execution;
  task.enough = enough;
  return task;
}

ScriptedWorker::Script say(const std::string& words) {
  return [words](const std::string&) { return words; };
}

}  // namespace

TEST_CASE_METHOD(
    Office,
    "of all that work at once the first acceptable result is taken, and the slowest is not waited "
    "for") {
  const Place place = GENERATE(Place::Inside, Place::Outside);
  Hang hang;
  const auto slow = add("slow", place, hang.script(), declared("10", "0.9"));
  add("wrong", Place::Inside, say("wrong"), declared("10", "0.8"));
  add("quick", Place::Inside, answer_as("quick"), declared("10", "0.1"));
  CHECK(perform(task_for(Execution::All), 60s) == "quick did it");
  CHECK(attempt_of("slow").outcome == introspection::Outcome::Cancelled);
  CHECK(attempt_of("quick").outcome == introspection::Outcome::Accepted);
  CHECK(record.execution == "all");
  CHECK(took() < 30s);
  hang.release();
}

TEST_CASE_METHOD(Office,
                 "the next CSP begins when the first is late, and the late one may still win",
                 "[wire]") {
  Hang hang, other_hang;
  const auto late = add("late", Place::Outside, hang.script(), declared("50", "0.9"));
  const auto next = add("next", Place::Outside, other_hang.script(), declared("50", "0.5"));
  std::string result;
  std::thread performer([&] { result = perform(task_for(Execution::Staggered), 60s); });
  const bool both = eventually([&] { return late->inside == 1 && next->inside == 1; });
  SECTION("the late one") {
    hang.release();
    performer.join();
    CHECK(attempts() == Lines{"late accepted", "next cancelled"});
    other_hang.release();
  }
  SECTION("the next one") {
    other_hang.release();
    performer.join();
    CHECK(attempts() == Lines{"late cancelled", "next accepted"});
    hang.release();
  }
  REQUIRE(both);
  CHECK(std::chrono::nanoseconds(record.attempts[1].began) >= 50ms);
}

TEST_CASE_METHOD(Office, "where the first is not late no other CSP begins") {
  add("first", Place::Inside, answer_as("first"), declared("5000", "0.9"));
  const auto second = add("second", Place::Inside, answer_as("second"), declared("5000", "0.5"));
  CHECK(perform(task_for(Execution::Staggered), 60s) == "first did it");
  CHECK(second->calls == 0);
}

TEST_CASE_METHOD(Office, "a vote ends as soon as enough agree", "[wire]") {
  Hang hang;
  add("a", Place::Inside, say("yes"), declared("10", "0.5"));
  add("b", Place::Outside, say("no"), declared("10", "0.5"));
  add("c", Place::Outside, say("yes"), declared("10", "0.5"));
  add("d", Place::Outside, hang.script(), declared("10", "0.5"));
  WorkTask vote = task_for(Execution::All, 2);
  vote.synthesis = majority_vote<std::string>(2);
  CHECK(perform(vote, 60s) == "yes");
  CHECK_THAT(record.synthesis,
             Catch::Contains("a") && Catch::Contains("c") && Catch::Contains("agree"));
  hang.release();
}

TEST_CASE_METHOD(Office, "where no majority agrees the task fails and says so") {
  add("a", Place::Inside, say("yes"), declared("10", "0.5"));
  add("b", Place::Inside, say("no"), declared("10", "0.5"));
  WorkTask vote = task_for(Execution::All, 2);
  vote.synthesis = majority_vote<std::string>(2);
  CHECK_THROWS_AS(perform(vote, 60s), NoneAccepted);
  CHECK_THAT(record.failure, Catch::Contains("do not agree"));
}

TEST_CASE_METHOD(Office, "that fewer CSPs answered than were to be waited for is told") {
  add("a", Place::Inside, say("yes"), declared("10", "0.5"));
  add("b", Place::Inside, say("yes"), declared("10", "0.5"));
  CHECK(perform(task_for(Execution::All, 3), 60s) == "yes");
  CHECK_THAT(record.synthesis, Catch::EndsWith("; of 2 results, where 3 were to be waited for"));
  WorkTask vote = task_for(Execution::All, 3);
  vote.synthesis = majority_vote<std::string>(3);
  CHECK_THROWS_AS(perform(vote, 60s), NoneAccepted);
  CHECK_THAT(record.failure,
             Catch::StartsWith("3 accepted results are needed, and 2 came of 2 CSPs"));
}

TEST_CASE_METHOD(
    Office, "a task that waits for each CSP, though all are to work at a time, is told so once") {
  const Log log;
  add("a", Place::Inside, say("yes"), declared("10", "0.5"));
  add("b", Place::Inside, say("yes"), declared("10", "0.5"));
  WorkTask waiting = Office::task();
  perform(waiting, 60s);
  CHECK(log.count("one after the other") == 0);
  waiting.execution = Execution::All;
  perform(waiting, 60s);
  perform(waiting, 60s);
  CHECK(log.count("the CSPs of crew/Worker are to work at a time (execution 'all'), but the "
                  "task's `run` waits for each: they work one after the other") == 1);
}

TEST_CASE_METHOD(Office,
                 "the best of all results is taken when all have answered, or the time is up") {
  Hang hang;
  add("short", Place::Inside, say("x"), declared("10", "0.5"));
  add("long", Place::Outside, say("xxxx"), declared("10", "0.5"));
  if (GENERATE(false, true)) add("hung", Place::Outside, hang.script(), declared("10", "0.5"));
  WorkTask best = task_for(Execution::All, TaskOptions::kAll);
  SECTION("by quality") {
    best.quality = [](const std::string& result) { return static_cast<double>(result.size()); };
    CHECK(perform(best, 1s) == "xxxx");
    CHECK(attempt_of("long").quality == std::vector{4.0});
  }
  SECTION("by cost") {
    best.synthesis = best_by_cost<std::string>(
        [](const std::string& result) { return static_cast<double>(result.size()); });
    CHECK(perform(best, 1s) == "x");
  }
  hang.release();
}

TEST_CASE_METHOD(Office, "no more CSPs work at a time than the task allows") {
  Hang hang;
  for (const char* name : {"a", "b", "c"})
    add(name, Place::Outside, hang.script(), declared("10", "0.5"));
  WorkTask two = task_for(Execution::All);
  two.width = 2;
  CHECK_THROWS_AS(perform(two, 500ms), TimedOut);
  CHECK(record.attempts.size() == 2);
  hang.release();
}

TEST_CASE("the answer is there at the deadline although every CSP hangs") {
  const auto execution = GENERATE(Execution::One, Execution::Staggered, Execution::All);
  const Place place = GENERATE(Place::Inside, Place::Outside);
  Hang hang;
  Office office(HeadOptions{.max_stuck = 2});
  for (const char* name : {"a", "b", "c"})
    office.add(name, place, hang.script(), declared("10", "0.5"));
  CHECK_THROWS_AS(office.perform(task_for(execution), 300ms), TimedOut);
  CHECK(office.took() < 10s);
  CHECK(office.took() >= 300ms);
  // On a loaded machine not every CSP that was tried has also begun by then.
  const bool inside = place == Place::Inside;
  CHECK(office.record.stuck <= (inside ? office.record.attempts.size() : 0));
  if (office.record.stuck >= 2) CHECK(office.owner->head().degraded());
  if (!inside) CHECK_FALSE(office.owner->head().degraded());
  hang.release();
  CHECK(eventually([&] { return !office.owner->head().degraded(); }));
}

TEST_CASE("who hangs in another process is told", "[wire]") {
  Hang hang;
  std::vector<std::string> told;
  HeadOptions options;
  options.on_hang = [&](const Candidate& candidate) { told.push_back(candidate.name); };
  Office office(options);
  office.add("inside", Place::Inside, hang.script(), declared("10", "0.5"));
  office.add("outside", Place::Outside, hang.script(), declared("10", "0.9"));
  CHECK_THROWS_AS(office.perform(task_for(Execution::One), 300ms), TimedOut);
  CHECK(told == Lines{"outside"});
  hang.release();
}

TEST_CASE_METHOD(Office,
                 "of a stream of results the last one counts, and at the deadline the last so far",
                 "[wire]") {
  const auto execution = GENERATE(Execution::One, Execution::Staggered, Execution::All);
  const Place place = GENERATE(Place::Inside, Place::Outside);
  Hang hang;
  WorkTask anytime = task_for(execution);
  anytime.run = [](crew::Worker::Proxy& worker, Duration) { return worker.improve("it"); };
  SECTION("the last one") {
    add("quick", place, answer_as("quick"), declared("10", "0.9"));
    CHECK(perform(anytime, 60s) == "quick did it");
  }
  SECTION("the last so far") {
    add("slow", place, hang.script(), declared("10", "0.9"));
    CHECK(perform(anytime, 500ms) == "draft of it");
  }
  hang.release();
}
