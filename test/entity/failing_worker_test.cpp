#include <catch2/catch.hpp>

#include "office.hpp"
#include "test/tools/invariant.hpp"

using namespace skein;
using namespace skein::test;
using namespace std::chrono_literals;
using crew::NoAnswer;
using Lines = std::vector<std::string>;

namespace {

ScriptedWorker::Script refuse(bool final_word) {
  return
      [final_word](const std::string&) -> std::string { throw NoAnswer("not today", final_word); };
}

ScriptedWorker::Script crash() {
  return [](const std::string&) -> std::string { throw std::runtime_error("a bug"); };
}

/// A CSP that is chosen first, in each of the two places, and a sound one that is chosen next.
struct FirstFails {
  FirstFails(Place place, ScriptedWorker::Script script)
      : first(office.add("first", place, std::move(script), declared("200", "0.9"))),
        second(office.add("second", Place::Inside, answer_as("second"), declared("100", "0.5"))) {}
  Office office;
  std::shared_ptr<ScriptedWorker> first;
  std::shared_ptr<ScriptedWorker> second;
};

}  // namespace

TEST_CASE("a CSP that throws, refuses, or whose result is rejected is followed by the next best",
          "[wire]") {
  const Place place = GENERATE(Place::Inside, Place::Outside);
  const auto& [script, outcome, text] =
      GENERATE(table<ScriptedWorker::Script, std::string, std::string>(
          {{crash(), "failed", "a bug"},
           {refuse(false), "refused", ""},
           {answer_as("wrong"), "rejected", "it is wrong did it"}}));
  FirstFails team(place, script);
  CHECK(team.office.perform(Office::task(), 10s) == "second did it");
  CHECK(team.office.attempts() == Lines{"first " + outcome, "second accepted"});
  CHECK_THAT(team.office.record.attempts[0].text, Catch::Contains(text));
}

TEST_CASE("a CSP that refuses is followed by nobody if its word settles the matter") {
  FirstFails team(GENERATE(Place::Inside, Place::Outside), refuse(true));
  CHECK_THROWS_AS(team.office.perform(Office::task(), 10s), NoAnswer);
  CHECK(team.office.attempts() == Lines{"first refused"});
  CHECK(team.second->calls == 0);
}

TEST_CASE("a CSP that hangs is given up in time for the next best", "[wire]") {
  const Place place = GENERATE(Place::Inside, Place::Outside);
  Hang hang;
  FirstFails team(place, hang.script());
  CHECK(team.office.perform(Office::task(), 3s) == "second did it");
  CHECK(team.office.attempts() == Lines{"first timed out", "second accepted"});
  CHECK(std::chrono::nanoseconds(team.office.record.attempts[0].slice) <= 2700ms);
  CHECK(team.office.took() < 3s);
  hang.release();
}

TEST_CASE_METHOD(Office, "where the only CSP has not returned, the next request says which") {
  Hang hang;
  add("stuck", Place::Inside, hang.script(), declared("1", "0.9"));
  CHECK_THROWS_AS(perform(Office::task(), 100ms), TimedOut);
  CHECK_THROWS_WITH(perform(Office::task(), 100ms),
                    Catch::Contains("stuck has not returned from an earlier request"));
  hang.release();
}

TEST_CASE("the error of a CSP that fails or hangs names it, and is of the same class") {
  const Place place = GENERATE(Place::Inside, Place::Outside);
  SECTION("fails") {
    Office office;
    office.add("worker", place, crash(), declared("1", "0.9"));
    CHECK_THROWS_AS(office.perform(Office::task(), 10s), Internal);
    CHECK_THROWS_WITH(office.perform(Office::task(), 10s),
                      Catch::StartsWith("CSP 'worker': ") && Catch::EndsWith("failed: a bug"));
  }
  SECTION("hangs") {
    Hang hang;
    Office office;
    office.add("worker", place, hang.script(), declared("1", "0.9"));
    try {
      office.perform(Office::task(), 1s);
      FAIL("it returned");
    } catch (const TimedOut& error) {
      CHECK_THAT(error.what(), Catch::StartsWith("CSP 'worker': "));
    }
    hang.release();
  }
}

TEST_CASE("an instance in the process that is stuck is not entered again before it has come back") {
  Hang hang;
  FirstFails team(Place::Inside, hang.script());
  team.office.perform(Office::task(), 500ms);
  REQUIRE(team.first->inside == 1);
  CHECK(team.office.perform(Office::task(), 10s) == "second did it");
  CHECK(team.office.attempts() == Lines{"second accepted"});
  CHECK(team.first->calls == 1);
  hang.release();
  CHECK(eventually([&] {
    team.office.perform(Office::task(), 10s);
    return team.first->calls == 2;
  }));
}

TEST_CASE("CSPs that lie: no wrong result is passed on, and none of them stays the first") {
  HeadOptions learned;
  learned.strategy = "learned";
  learned.exploration = 0;
  Office office(std::move(learned));
  office.add("honest", Place::Inside, answer_as("honest"), declared("20", "0.2"));
  office.add("liar", Place::Inside, answer_as("wrong"), declared("5", "0.99"));
  office.add("fraud", Place::Outside, answer_as("wrong fraud"), declared("4", "0.98"));
  int honest_first = 0;
  for (int request = 0; request < 30; ++request) {
    const std::string answer = office.perform(Office::task(), 10s);
    INVARIANT(answer == "honest did it");
    if (request >= 20 && office.attempts().front() == "honest accepted") ++honest_first;
  }
  CHECK(honest_first > 5);
}

TEST_CASE_METHOD(
    Office, "where every result is rejected the task fails with what was wrong with the last one") {
  add("first", Place::Outside, answer_as("wrong first"), declared("20", "0.9"));
  add("second", Place::Inside, answer_as("wrong second"), declared("10", "0.5"));
  CHECK_THROWS_AS(perform(Office::task(), 10s), Internal);
  CHECK_THROWS_WITH(perform(Office::task(), 10s),
                    Catch::Contains("the last one, of CSP 'second': it is wrong second did it"));
  CHECK(attempts() == Lines{"first rejected", "second rejected"});
}

TEST_CASE_METHOD(
    Office,
    "where every CSP fails the task ends with the last one's error, and the record tells of all") {
  add("first", Place::Outside, crash(), declared("20", "0.9"));
  add("second", Place::Inside, refuse(false), declared("10", "0.5"));
  CHECK_THROWS_AS(perform(Office::task(), 10s), NoAnswer);
  CHECK(attempts() == Lines{"first failed", "second refused"});
}

TEST_CASE("a client has its answer by its deadline although the CSP that was chosen hangs") {
  const Place place = GENERATE(Place::Inside, Place::Outside);
  Hang hang;
  FirstFails team(place, hang.script());
  team.office.owner->provide<crew::Desk>(std::make_shared<OfficeBody>(team.office.owner->head()));
  const auto client = make_client();
  auto desk = client->connect<crew::Desk>();
  CHECK(desk.within(1s).ask("x") == "second did x");
  hang.release();
}

TEST_CASE_METHOD(Office,
                 "an entity that ends waits no longer for several CSPs that hang than for one") {
  Hang hang;
  std::vector<Call<std::string>> calls;
  for (const std::string name : {"a", "b", "c", "d"}) {
    const auto worker = add(name, Place::Inside, hang.script(), declared("10", "0.5"));
    auto proxy = owner->connect<crew::Worker>({.name = name}).within(10min);
    calls.push_back(proxy.async_work("it"));
    REQUIRE(eventually([&] { return worker->inside == 1; }));
  }
  const auto begin = std::chrono::steady_clock::now();
  owner.reset();
  // For one it waits 2 s.
  CHECK(std::chrono::steady_clock::now() - begin < 6s);
  for (auto& call : calls) CHECK_THROWS_AS(call.get(), Disconnected);
  hang.release();
}

namespace {

/// A function of a Body's that throws, and what is to be said of it.
struct Faulty {
  std::string who;
  std::function<void(WorkTask&, const std::function<void()>& fail)> put;
};

const std::vector<Faulty> kFaulty{
    {"the task's `run`",
     [](WorkTask& task, const std::function<void()>& fail) {
       task.run = [fail](crew::Worker::Proxy&, Duration) {
         fail();
         return std::string();
       };
     }},
    {"the check 'map'",
     [](WorkTask& task, const std::function<void()>& fail) {
       task.evaluate.check("map", [fail](const std::string&) {
         fail();
         return std::nullopt;
       });
     }},
    {"the task's `quality`",
     [](WorkTask& task, const std::function<void()>& fail) {
       task.quality = [fail](const std::string&) {
         fail();
         return 1.0;
       };
     }},
    {"the task's `synthesis`",
     [](WorkTask& task, const std::function<void()>& fail) {
       task.synthesis = [fail](const std::vector<Opinion<std::string>>&) {
         fail();
         return std::optional<Synthesised<std::string>>();
       };
     }},
};

}  // namespace

TEST_CASE("what a Body's own function throws is told as the Body's, and no CSP pays for it") {
  const auto& [who, put] = GENERATE(from_range(kFaulty));
  const bool standard = GENERATE(true, false);
  CAPTURE(who);
  Office office;
  office.add("first", Place::Inside, answer_as("first"), declared("10", "0.9"));
  office.add("second", Place::Inside, answer_as("second"), declared("10", "0.5"));
  WorkTask task = Office::task();
  put(task, [standard] {
    if (standard) throw std::runtime_error("my bug");
    throw 42;
  });
  const std::string text =
      who + " threw: " + (standard ? "my bug" : "something that is no std::exception");
  for (int request = 0; request < 4; ++request) {
    CHECK_THROWS_AS(office.perform(task, 10s), Internal);
    CHECK_THROWS_WITH(office.perform(task, 10s), text);
  }
  CHECK(office.record.failure == text);
  for (const auto& candidate : office.record.candidates)
    CHECK(candidate.breaker == introspection::BreakerState::Closed);
  const bool of_results = who == "the task's `synthesis`";  // those were good
  const auto learned =
      office.owner->head().history().predict("crew/Worker", {"first", "second"}, {});
  for (const auto& prediction : learned) CHECK((of_results || !prediction));
}

TEST_CASE_METHOD(Office,
                 "what decides whether a refusal is final may throw, too, and no CSP pays for it") {
  add("only", Place::Inside, refuse(false), declared("10", "0.9"));
  WorkTask task = Office::task();
  task.settles = [](const UserException&, const Candidate&) -> bool {
    throw std::runtime_error("my bug");
  };
  CHECK_THROWS_WITH(perform(task, 10s), "the task's `settles` threw: my bug");
}

TEST_CASE_METHOD(Office,
                 "an error of a Skein call inside a check keeps its class, and is the check's") {
  add("only", Place::Inside, answer_as("only"), declared("10", "0.9"));
  WorkTask task = Office::task();
  task.evaluate.check("map", [](const std::string&) -> std::optional<std::string> {
    throw Unavailable("no map service");
  });
  CHECK_THROWS_AS(perform(task, 10s), Unavailable);
  CHECK_THROWS_WITH(perform(task, 10s), "the check 'map' threw: no map service");
  CHECK(attempt_of("only").check == "map");
}

TEST_CASE("a strategy that fails is named, and its CSPs stay out of quarantine") {
  struct Stingy final : SelectionStrategy {
    std::string name() const override { return "stingy"; }
    Selection select(const std::vector<Candidate>&, const Situation&) const override {
      return {0, -5ms, "it is the first"};
    }
  };
  Office office(HeadOptions{.strategy = "stingy", .strategies = {std::make_shared<Stingy>()}});
  const auto first = office.add("first", Place::Inside, answer_as("first"), declared("10", "0.9"));
  CHECK_THROWS_WITH(
      office.perform(Office::task(), 300ms),
      Catch::StartsWith("the strategy 'stingy' gave CSP 'first' a time slice of -5 "));
  CHECK(first->calls == 0);
  CHECK(office.record.attempts.empty());
}
