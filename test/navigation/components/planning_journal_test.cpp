#include "navigation/components/planning_journal.hpp"

#include <catch2/catch.hpp>

using namespace skein;
using namespace skein::navigation;
using introspection::Attempt;
using introspection::BreakerState;
using introspection::CandidateReport;
using introspection::Decision;
using introspection::Outcome;
using namespace std::chrono_literals;

namespace {

constexpr std::int64_t kMs = 1'000'000;

CandidateReport candidate(const std::string& csp, std::int64_t latency_ms, double quality) {
  CandidateReport candidate;
  candidate.csp = csp;
  candidate.latency = {latency_ms * kMs};
  candidate.quality = quality;
  return candidate;
}

Attempt attempt(const std::string& csp, const std::string& reason, std::int64_t took_ms,
                Outcome outcome, const std::string& text) {
  Attempt attempt;
  attempt.csp = csp;
  attempt.reason = reason;
  attempt.took = took_ms * kMs;
  attempt.outcome = outcome;
  attempt.text = text;
  return attempt;
}

Decision record() {
  Decision record;
  record.candidates = {candidate("RRTstar", 1500, 0.95), candidate("AStar", 300, 0.9)};
  record.attempts = {attempt("RRTstar", "it is the best", 200, Outcome::Disconnected, "it died"),
                     attempt("AStar", "it is the next best", 100, Outcome::Accepted, "")};
  record.took = 301 * kMs;
  return record;
}

}  // namespace

TEST_CASE("a request's report tells who was available, who was tried, why and what came of it") {
  PlanningJournal journal;
  journal.begin("one");
  journal.end("one", {{0, record()}}, "");
  const auto report = journal.report("one");
  REQUIRE(report.attempts.size() == 2);
  CHECK(report.attempts[0].planner == "RRTstar");
  CHECK(report.attempts[0].reason == "it is the best");
  CHECK(report.attempts[0].outcome == "disconnected");
  CHECK(report.attempts[0].text == "it died");
  CHECK(report.attempts[0].took_ms == Approx(200));
  CHECK(report.attempts[1].planner == "AStar");
  CHECK(report.attempts[1].outcome == "accepted");
  CHECK(report.elapsed_ms == Approx(301));
  REQUIRE(report.candidates.size() == 2);
  CHECK(report.candidates[0].declared_ms == Approx(1500));
  CHECK(report.candidates[0].runs == 0);
  CHECK(report.candidates[0].available);
}

TEST_CASE("what a planner has shown is reported beside what it declares") {
  Decision shown = record();
  shown.candidates[1].learned = {{{}, 7, {120 * kMs}, {250 * kMs}, {0.8}, 0.875, 0}};
  shown.candidates[1].breaker = BreakerState::Open;
  PlanningJournal journal;
  journal.begin("one");
  journal.end("one", {{0, shown}}, "");
  const auto planner = journal.report("one").candidates.at(1);
  CHECK(planner.declared_ms == Approx(300));
  CHECK(planner.runs == 7);
  CHECK(planner.median_ms == Approx(120));
  CHECK(planner.p95_ms == Approx(250));
  CHECK(planner.measured_quality == Approx(0.8));
  CHECK(planner.accepted == Approx(0.875));
  CHECK(planner.quarantined);
}

TEST_CASE("a request that was planned twice is one report, each attempt with its threats") {
  PlanningJournal journal;
  journal.begin("one");
  journal.end("one", {{3, record()}, {4, record()}}, "");
  const auto report = journal.report("one");
  REQUIRE(report.attempts.size() == 4);
  CHECK(report.attempts[1].threat_epoch == 3);
  CHECK(report.attempts[2].threat_epoch == 4);
  CHECK(report.candidates.size() == 2);
  CHECK(report.elapsed_ms == Approx(602));
}

TEST_CASE("a planner that was available once and is gone is reported as not available") {
  PlanningJournal journal;
  journal.begin("one");
  journal.end("one", {{0, record()}}, "");
  Decision later = record();
  later.candidates.erase(later.candidates.begin());
  journal.begin("two");
  journal.end("two", {{0, later}}, "");
  const auto report = journal.report("two");
  REQUIRE(report.candidates.size() == 2);
  CHECK(report.candidates[1].planner == "RRTstar");
  CHECK_FALSE(report.candidates[1].available);
}

TEST_CASE("the report of a request that no planner was tried for gives the error") {
  PlanningJournal journal;
  journal.begin("one");
  journal.end("one", {}, "no planner is available");
  CHECK(journal.report("one").failure == "no planner is available");
}

TEST_CASE("the last 64 reports are kept, an unknown request is refused by its name") {
  PlanningJournal journal;
  for (int i = 0; i < 65; ++i) {
    journal.begin(std::to_string(i));
    journal.end(std::to_string(i), {{0, record()}}, "");
  }
  CHECK(journal.report("1").request_id == "1");
  CHECK(journal.report("64").request_id == "64");
  CHECK_THROWS_AS(journal.report("0"), AE_navigatorI::UnknownRequest);
  CHECK_THROWS_WITH(journal.report("0"), Catch::Contains("'0'"));
}

TEST_CASE("the request at work is the one that began last of those that have not ended") {
  PlanningJournal journal;
  CHECK(journal.current().empty());
  journal.begin("one");
  journal.begin("two");
  CHECK(journal.current() == "two");
  journal.end("two", {{0, record()}}, "");
  CHECK(journal.current() == "one");
  CHECK(journal.at_work() == 1);
}
