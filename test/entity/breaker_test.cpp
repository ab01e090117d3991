#include <catch2/catch.hpp>

#include "office.hpp"
#include "test/tools/log.hpp"

using namespace skein;
using namespace skein::test;
using namespace std::chrono_literals;
using Lines = std::vector<std::string>;

namespace {

constexpr CircuitBreaker::Rules kHasty{
    .faults = 2, .first_quarantine = 1ms, .longest_quarantine = 1ms};

ScriptedWorker::Script crash_while(std::shared_ptr<std::atomic<bool>> sick) {
  return [sick](const std::string& task) -> std::string {
    if (*sick) throw std::runtime_error("a bug");
    return "patient did " + task;
  };
}

}  // namespace

TEST_CASE_METHOD(Office, "a CSP that fails again and again is quarantined, whatever it declares") {
  const auto sick = std::make_shared<std::atomic<bool>>(true);
  const auto patient = add("patient", Place::Inside, crash_while(sick), declared("10", "0.9"));
  add("sound", Place::Inside, answer_as("sound"), declared("10", "0.5"));
  for (int i = 0; i < 3; ++i) perform(Office::task(), 10s);
  CHECK(attempts() == Lines{"patient failed", "sound accepted"});
  perform(Office::task(), 10s);
  CHECK(attempts() == Lines{"sound accepted"});
  CHECK(patient->calls == 3);
}

TEST_CASE("after its quarantine a CSP is probed, and works again once it is well") {
  Office office(HeadOptions{.breaker = kHasty});
  const auto sick = std::make_shared<std::atomic<bool>>(true);
  const auto patient =
      office.add("patient", Place::Inside, crash_while(sick), declared("10", "0.9"));
  office.add("sound", Place::Inside, answer_as("sound"), declared("10", "0.5"));
  CHECK(eventually([&] {
    office.perform(Office::task(), 10s);
    return patient->calls >= 4;
  }));
  *sick = false;
  CHECK(eventually([&] { return office.perform(Office::task(), 10s) == "patient did it"; }));
  office.perform(Office::task(), 10s);
  CHECK(office.attempts() == Lines{"patient accepted"});
}

TEST_CASE_METHOD(Office,
                 "where every CSP is quarantined the one whose quarantine ends first is tried") {
  const auto sick = std::make_shared<std::atomic<bool>>(true);
  add("patient", Place::Inside, crash_while(sick), declared("10", "0.9"));
  for (int i = 0; i < 3; ++i)
    CHECK_THROWS_WITH(perform(Office::task(), 10s), "CSP 'patient': 'work' failed: a bug");
  *sick = false;
  CHECK(perform(Office::task(), 10s) == "patient did it");
  CHECK(record.candidates[0].breaker == introspection::BreakerState::Open);
}

TEST_CASE_METHOD(
    Office, "what is late by less than four times what was expected of it is not quarantined") {
  Hang hang;
  add("thorough", Place::Outside, hang.script(), declared("60000", "0.9"));
  for (int i = 0; i < 4; ++i) CHECK_THROWS_AS(perform(Office::task(), 30ms), TimedOut);
  CHECK(record.candidates[0].breaker == introspection::BreakerState::Closed);
  hang.release();
}

TEST_CASE_METHOD(
    Office,
    "a result of which the CSP itself admits that it is approximate is no success and no fault") {
  add("rough", Place::Inside, answer_as("about"), declared("10", "0.9"));
  add("exact", Place::Inside, answer_as("exact"), declared("10", "0.5"));
  WorkTask task = Office::task();
  task.evaluate = {};
  task.evaluate.admitted("exact", [](const std::string& result) {
    return result.starts_with("about") ? std::optional<std::string>("it is approximate")
                                       : std::nullopt;
  });
  for (int i = 0; i < 5; ++i) {
    CHECK(perform(task, 10s) == "exact did it");
    CHECK(attempts() == Lines{"rough rejected", "exact accepted"});
    CHECK(record.attempts[0].check == "exact");
  }
}

TEST_CASE("that a CSP is put into quarantine is told once for each cause, with the reason") {
  const Log log;
  Office office(HeadOptions{.breaker = kHasty});
  const auto reason = std::make_shared<std::string>("drive not homed");
  const auto patient = office.add(
      "patient", Place::Inside,
      [reason](const std::string& task) -> std::string {
        if (!reason->empty()) throw std::runtime_error(*reason);
        return "patient did " + task;
      },
      declared("10", "0.9"));
  office.add("sound", Place::Inside, answer_as("sound"), declared("10", "0.5"));
  const auto told = [&](const std::string& why) {
    return log.count("uav-1/office: CSP 'patient' is in quarantine: " + why);
  };
  const auto fail_and_recover = [&](const std::string& why) {
    *reason = why;
    const int before = patient->calls;
    REQUIRE(eventually([&] {
      office.perform(Office::task(), 10s);
      return patient->calls >= before + 5;
    }));
    *reason = "";
    REQUIRE(eventually([&] { return office.perform(Office::task(), 10s) == "patient did it"; }));
  };
  office.perform(Office::task(), 10s);
  CHECK(told("") == 0);
  fail_and_recover("drive not homed");
  CHECK(told("'work' failed: drive not homed") == 1);
  fail_and_recover("drive not homed");
  CHECK(told("") == 1);
  fail_and_recover("drive too hot");
  CHECK(told("'work' failed: drive too hot") == 1);
  CHECK(told("") == 2);
}

TEST_CASE("a CSP whose results are rejected is told of with the check that rejects them") {
  const Log log;
  Office office(HeadOptions{.breaker = kHasty});
  office.add("liar", Place::Inside, answer_as("wrong"), declared("10", "0.9"));
  office.add("sound", Place::Inside, answer_as("sound"), declared("10", "0.5"));
  for (int i = 0; i < 5; ++i) office.perform(Office::task(), 10s);
  CHECK(log.count("CSP 'liar' is in quarantine: the check 'evaluation' rejects its result: it is "
                  "wrong did it") == 1);
  CHECK(log.count("\n") == 1);
}

TEST_CASE("a CSP in the process that does not return is told of when that shows, once") {
  const Log log;
  Hang hang;
  Office office(HeadOptions{.max_stuck = 1});
  office.add("stuck", Place::Inside, hang.script(), declared("1", "0.9"));
  office.add("sound", Place::Inside, answer_as("sound"), declared("10", "0.5"));
  for (int i = 0; i < 3; ++i) office.perform(Office::task(), 2s);
  CHECK(log.count("uav-1/office: CSP 'stuck' has not returned from a request whose time is over; "
                  "it is not asked again before it returns") == 1);
  CHECK(log.count("CSPs in this process that do not return: stuck; as many as max_stuck (1)") == 1);
  CHECK(log.count("\n") == 2);
  hang.release();
}

TEST_CASE("a quarantine may be longer than any clock counts") {
  CircuitBreaker breaker({.faults = 1,
                          .first_quarantine = Duration::max() / 2 + 1s,
                          .longest_quarantine = Duration::max()});
  const Instant now(1h);
  for (int i = 0; i < 2; ++i) {
    breaker.trip(now);
    CHECK(breaker.state(now + 24h * 365) == CircuitBreaker::State::Open);
    CHECK(breaker.quarantine(now) > 24h * 365);
  }
}
