#include "entity/head/running_csps.hpp"

#include <catch2/catch.hpp>

#include "test/tools/log.hpp"

using namespace skein;
using namespace std::chrono_literals;
using entity::RunEnding;
using introspection::Outcome;
using State = CircuitBreaker::State;

namespace {

struct RunningStage {
  ManualClock clock;
  entity::HeadWarnings warnings{"uav-1/office"};
  entity::RunningCsps running{
      clock, {.faults = 1, .first_quarantine = 1s, .longest_quarantine = 1s}, warnings};
  InterfaceInfo interface = {"crew::Worker", {}, {}, {}};

  /// As a Head lists it now.
  Candidate listed(const std::string& name) const {
    std::vector<Candidate> candidates(1);
    candidates[0].name = name;
    running.note_quarantine(interface, candidates, clock.now());
    return candidates[0];
  }

  std::optional<std::uint64_t> begin(const Candidate& candidate) {
    return running.begin(interface, candidate, std::make_shared<const std::string>("here"),
                         clock.now());
  }

  void end(const Candidate& candidate, std::uint64_t run, const RunEnding& ending,
           bool hangs = false) {
    running.end(interface, candidate, run, ending, hangs);
  }
};

const RunEnding kFault{.outcome = Outcome::Failed, .fault = true, .reason = "a bug"};
const RunEnding kSuccess{.outcome = Outcome::Accepted};
const RunEnding kCancelled{.outcome = Outcome::Cancelled};

}  // namespace

TEST_CASE_METHOD(RunningStage, "a CSP that was quarantined since it was listed is not started") {
  const Candidate before = listed("patient");
  end(before, begin(before).value(), kFault);
  CHECK(running.list().empty());
  CHECK_FALSE(begin(before));
  CHECK(running.list().empty());

  SECTION("but as the last resort, which is listed as quarantined") {
    const Candidate last_resort = listed("patient");
    CHECK(last_resort.breaker == State::Open);
    CHECK(last_resort.quarantine == 1s);
    CHECK(begin(last_resort));
  }
  SECTION("until its quarantine is over, after which one request probes it") {
    clock.advance(1s);
    CHECK(begin(before));
    CHECK_FALSE(begin(before));
  }
  SECTION("and others are") { CHECK(begin(listed("sound"))); }
}

TEST_CASE_METHOD(RunningStage, "a quarantine is logged when it begins, once for each reason") {
  const test::Log log;
  const auto fail = [&](const std::string& reason) {
    const Candidate candidate = listed("patient");
    RunEnding ending = kFault;
    ending.reason = reason;
    end(candidate, begin(candidate).value(), ending);
  };
  const auto recover = [&] {
    clock.advance(1s);
    const Candidate candidate = listed("patient");
    end(candidate, begin(candidate).value(), kSuccess);
  };
  fail("a bug");
  fail("a bug");  // the last resort
  CHECK(log.text() == "uav-1/office: CSP 'patient' is in quarantine: a bug\n");
  recover();
  fail("a bug");
  CHECK(log.count("\n") == 1);
  recover();
  fail("too hot");
  CHECK(log.count("CSP 'patient' is in quarantine: too hot") == 1);
}

TEST_CASE("a CSP that hangs is quarantined at its first fault") {
  const test::Log log;
  ManualClock clock;
  entity::HeadWarnings warnings("uav-1/office");
  entity::RunningCsps running(clock, {.faults = 3}, warnings);
  const InterfaceInfo interface = {"crew::Worker", {}, {}, {}};
  Candidate candidate;
  candidate.name = "slow";
  const bool hangs = GENERATE(false, true);
  const auto run = running.begin(interface, candidate, nullptr, clock.now());
  running.end(interface, candidate, run.value(), kFault, hangs);
  CHECK(log.count("CSP 'slow' is in quarantine") == (hangs ? 1 : 0));
}

TEST_CASE_METHOD(RunningStage, "a cancelled probe leaves the quarantine as it was") {
  const Candidate candidate = listed("patient");
  end(candidate, begin(candidate).value(), kFault);
  clock.advance(1s);
  end(candidate, begin(candidate).value(), kCancelled);
  CHECK(listed("patient").breaker == State::HalfOpen);
}

TEST_CASE_METHOD(RunningStage, "each run is listed until it ends") {
  const Candidate candidate = listed("twice");
  const auto first = begin(candidate).value();
  const auto second = begin(candidate).value();
  CHECK(first != second);
  CHECK(running.list().size() == 2);
  end(candidate, first, kSuccess);
  REQUIRE(running.list().size() == 1);
  CHECK(running.list()[0].csp == "twice");
  CHECK(running.list()[0].host == "here");
}
