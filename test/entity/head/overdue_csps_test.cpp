#include "entity/head/overdue_csps.hpp"

#include <catch2/catch.hpp>
#include <set>

#include "test/tools/log.hpp"

using namespace skein;
using namespace std::chrono_literals;

namespace {

const std::string kStuck =
    "CSP 'stuck' has not returned from a request whose time is over; it is not asked again before "
    "it returns";
const std::string kHeld =
    "CSP 'held' has not returned from a request whose time is over; it runs on its caller's "
    "thread, which waits for it: give it a thread of its own (CallThread::Own)";

Candidate inside(const std::string& name) {
  Candidate candidate;
  candidate.name = name;
  candidate.provider = Guid::random();
  candidate.in_process = true;
  return candidate;
}

struct OverdueStage {
  test::Log log;
  ManualClock clock;
  std::set<Guid> at_work;
  std::set<Guid> on_callers;
  entity::HeadWarnings warnings{"uav-1/office"};
  entity::OverdueCsps overdue{"uav-1/office",
                              clock,
                              2,
                              {[&](const Guid& provider) { return at_work.contains(provider); },
                               [&](const Guid& provider) { return on_callers.contains(provider); }},
                              warnings};
  InterfaceInfo interface = {"crew::Worker", {}, {}, {}};

  void add(const Candidate& candidate, bool hangs) {
    at_work.insert(candidate.provider);
    overdue.add(interface, candidate, hangs);
  }
};

}  // namespace

TEST_CASE_METHOD(OverdueStage, "a CSP that hangs is counted until it returns, and logged once") {
  const Candidate stuck = inside("stuck");
  add(stuck, true);
  CHECK(overdue.count() == 1);
  CHECK(overdue.count() == 1);
  CHECK(log.text() == "uav-1/office: " + kStuck + "\n");
  at_work.clear();
  CHECK(overdue.count() == 0);
}

TEST_CASE_METHOD(OverdueStage,
                 "a CSP that is slightly late is logged if it still is at the next count") {
  const Candidate stuck = inside("stuck");
  add(stuck, false);
  CHECK(overdue.count() == 1);
  CHECK(log.text().empty());
  SECTION("as it has not returned") {
    overdue.count();
    CHECK(log.count(kStuck) == 1);
  }
  SECTION("but not once it has returned") {
    at_work.clear();
    overdue.count();
    CHECK(log.text().empty());
  }
}

TEST_CASE_METHOD(OverdueStage, "an error is logged each time that too many CSPs come to be stuck") {
  const std::string error = "as many as max_stuck (2), so that it should be restarted";
  const Candidate one = inside("one");
  const Candidate two = inside("two");
  add(one, true);
  overdue.count();
  CHECK(log.count(error) == 0);
  add(two, true);
  overdue.count();
  overdue.count();
  CHECK(log.count(error) == 1);
  at_work.erase(one.provider);
  CHECK(overdue.count() == 1);
  add(one, true);
  overdue.count();
  CHECK(log.count(error) == 2);
}

TEST_CASE_METHOD(OverdueStage,
                 "a CSP that holds its caller's thread is logged when its time is over") {
  const Candidate held = inside("held");
  on_callers.insert(held.provider);
  {
    const entity::OverdueCsps::Watch watch(overdue, interface, held, clock.now() + 300ms);
    clock.advance(299ms);
    CHECK(log.text().empty());
    clock.advance(1ms);
    CHECK(log.text() == "uav-1/office: " + kHeld + "\n");
    clock.advance(1h);
    CHECK(log.count("\n") == 1);
  }
  SECTION("within a second, if another's time was to end later") {
    const Candidate again = inside("held");
    const Candidate other = inside("other");
    on_callers = {again.provider, other.provider};
    const entity::OverdueCsps::Watch longer(overdue, interface, other, clock.now() + 1h);
    warnings.tell(interface.name, "held", " is well");
    const entity::OverdueCsps::Watch shorter(overdue, interface, again, clock.now() + 300ms);
    clock.advance(1s);
    CHECK(log.count(kHeld) == 2);
    CHECK(log.count("CSP 'other'") == 0);
  }
}

TEST_CASE_METHOD(OverdueStage,
                 "a CSP on a thread of its own, or elsewhere, holds no caller's thread") {
  Candidate csp = inside("held");
  SECTION("on a thread of its own") {}
  SECTION("in another process") {
    on_callers.insert(csp.provider);
    csp.in_process = false;
  }
  const entity::OverdueCsps::Watch watch(overdue, interface, csp, clock.now());
  clock.advance(10s);
  CHECK(log.text().empty());
}
