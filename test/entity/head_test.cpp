#include <catch2/catch.hpp>

#include "office.hpp"
#include "skein/introspection.idl.hpp"

using namespace skein;
using namespace skein::test;
using namespace std::chrono_literals;

TEST_CASE("the Head selects by declared quality among those that fit into the time") {
  Office office;
  office.add("thorough", Place::Outside, answer_as("thorough"), declared("2000", "0.9"));
  office.add("quick", Place::Inside, answer_as("quick"), declared("10", "0.5"));
  CHECK(office.perform(Office::task("a"), 10s) == "thorough did a");
  CHECK(office.perform(Office::task("b"), 1s) == "quick did b");
}

TEST_CASE("a decision's record holds candidates, choice, reason, outcome and times") {
  Office office;
  office.add("thorough", Place::Outside, answer_as("thorough"), declared("2000", "0.9"));
  office.add("quick", Place::Inside, answer_as("quick"), declared("10", "0.5"));
  office.perform(Office::task(), 10s);
  const DecisionRecord& record = office.record;
  CHECK(record.interface == "crew/Worker");
  CHECK(record.strategy == "declared");
  CHECK(record.available == 10s);
  REQUIRE(record.candidates.size() == 2);
  for (const Candidate& candidate : record.candidates) {
    const bool quick = candidate.name == "quick";
    CHECK(candidate.in_process == quick);
    CHECK(candidate.latency == (quick ? Duration(10ms) : Duration(2s)));
    CHECK(candidate.quality == (quick ? 0.5 : 0.9));
    CHECK(candidate.pid == static_cast<std::uint32_t>(getpid()));
  }
  REQUIRE(office.attempts() == std::vector<std::string>{"thorough accepted"});
  CHECK_THAT(record.attempts[0].reason, Catch::Contains("best declared quality"));
  CHECK(record.attempts[0].slice <= record.available - 10ms);
  CHECK(record.took >= record.attempts[0].took);
}

TEST_CASE("the last 64 decisions are kept and numbered") {
  Office office;
  office.add("quick", Place::Inside, answer_as("quick"), declared("10", "0.5"));
  for (int i = 0; i < 70; ++i) office.perform(Office::task(), 1s);
  const auto decisions = office.owner->head().decisions();
  REQUIRE(decisions.size() == 64);
  CHECK(decisions.front().number == 7);
  CHECK(decisions.back().number == 70);
}

TEST_CASE("only the CSP that is asked for by name runs") {
  Office office;
  office.add("thorough", Place::Outside, answer_as("thorough"), declared("20", "0.9"));
  office.add("quick", Place::Inside, answer_as("quick"), declared("10", "0.5"));
  WorkTask task = Office::task();
  task.only = "quick";
  CHECK(office.perform(task, 10s) == "quick did it");
  task.only = "nobody";
  CHECK_THROWS_AS(office.perform(task, 10s), Unavailable);
  CHECK_THROWS_WITH(office.perform(task, 10s),
                    Catch::Contains("'nobody'") && Catch::Contains("crew/Worker"));
}

TEST_CASE("without any CSP a task is refused with the reason") {
  Office office;
  CHECK_THROWS_AS(office.perform(Office::task(), 1s), Unavailable);
  CHECK_THROWS_WITH(office.perform(Office::task(), 1s), Catch::Contains("crew/Worker"));
}

TEST_CASE("a client's session selects by the strategy that it asked for") {
  struct Slowest final : SelectionStrategy {
    std::string name() const override { return "slowest"; }
    Selection select(const std::vector<Candidate>& candidates,
                     const Situation& situation) const override {
      std::size_t slowest = 0;
      for (std::size_t i = 1; i < candidates.size(); ++i) {
        if (candidates[i].latency > candidates[slowest].latency) slowest = i;
      }
      return {slowest, situation.remaining, "it is the slowest"};
    }
  };
  Office office;
  office.owner->head().add_strategy(std::make_shared<Slowest>());
  office.add("slow", Place::Outside, answer_as("slow"), declared("60000", "0.1"));
  office.add("quick", Place::Inside, answer_as("quick"), declared("10", "0.5"));
  office.owner->provide<crew::Desk>(std::make_shared<OfficeBody>(office.owner->head()));
  const auto client = make_client();
  auto by_default = client->connect<crew::Desk>();
  auto by_own = client->connect<crew::Desk>({.strategy = "slowest"});
  CHECK(by_default.ask("a") == "quick did a");
  CHECK(by_own.ask("b") == "slow did b");
  CHECK(by_default.ask("c") == "quick did c");
}

TEST_CASE("the time of a task is the caller's, whatever the Body would give") {
  Office office;
  office.add("thorough", Place::Outside, answer_as("thorough"), declared("3000", "0.9"));
  office.add("quick", Place::Inside, answer_as("quick"), declared("1", "0.5"));
  office.owner->provide<crew::Desk>(std::make_shared<OfficeBody>(office.owner->head()));
  const auto client = make_client();
  auto desk = client->connect<crew::Desk>();
  CHECK(desk.within(2s).ask("a") == "quick did a");
  CHECK(desk.within(20s).ask("b") == "thorough did b");
}

TEST_CASE("who works for the Head now is known while it works") {
  Office office;
  Hang hang;
  const auto worker = office.add("slow", Place::Outside, hang.script(), declared("10", "0.5"));
  std::thread other([&] { office.perform(Office::task(), 60s); });
  const bool entered = eventually([&] { return worker->inside == 1; });
  const auto running = office.owner->head().running();
  hang.release();
  other.join();
  REQUIRE(entered);
  REQUIRE(running.size() == 1);
  CHECK(running[0].csp == "slow");
  CHECK(running[0].pid == static_cast<std::uint32_t>(getpid()));
  CHECK(office.owner->head().running().empty());
}

TEST_CASE("a client changes its strategy by disconnecting and connecting again") {
  Office office;
  office.add("a", Place::Inside, answer_as("a"), declared("10", "0.1"));
  office.add("b", Place::Inside, answer_as("b"), declared("10", "0.9"));
  office.owner->provide<crew::Desk>(std::make_shared<OfficeBody>(office.owner->head()));
  const auto client = make_client();
  const std::string first = office.owner->broker()
                                .find_service(office.owner->broker().query("crew/Worker"))
                                .front()
                                ->entity;
  for (const std::string strategy : {"declared", "fixed_order", "learned"}) {
    auto desk = client->connect<crew::Desk>({.strategy = strategy});
    CHECK(desk.ask("it") == (strategy == "fixed_order" ? first : "b") + " did it");
    CHECK(office.owner->head().decisions().back().strategy == strategy);
    desk.disconnect();
  }
}

TEST_CASE("a Body may call the CSP that the Head selects beforehand itself") {
  const Place place = GENERATE(Place::Inside, Place::Outside);
  Office office;
  office.add("better", place, answer_as("better"), declared("10", "0.9"));
  office.add("other", Place::Inside, answer_as("other"), declared("10", "0.5"));
  auto worker = office.owner->head().preselect<crew::Worker>();
  CHECK(worker.work("a") == "better did a");
  CHECK(worker.work("b") == "better did b");
  REQUIRE(office.owner->head().decisions().size() == 1);
  office.record = office.owner->head().decisions().front();
  CHECK(office.attempts() == std::vector<std::string>{"better preselected"});
  CHECK_THAT(explain(office.record), Catch::Contains("for the Body to call itself") &&
                                         Catch::Contains("better has the best declared quality"));
  CHECK(replay(record_of(report_of(office.record))).front().csp == "better");
}

TEST_CASE("without any CSP nothing can be selected beforehand") {
  Office office;
  CHECK_THROWS_AS(office.owner->head().preselect<crew::Worker>(), NoCandidate);
}
