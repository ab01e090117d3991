// The mission's time in lock-step, in invented time and without a network.
#include <catch2/catch.hpp>
#include <vector>

#include "clock/lock_step.hpp"
#include "clock/pace.hpp"

namespace clock_test {

using namespace reconnaissance;
using namespace std::chrono_literals;
using skein::Instant;

namespace {

Told told(const std::string& name, int period, Tick done = -1, std::uint64_t life = 1) {
  return {.participant = name, .life = life, .period = period, .done = done};
}

}  // namespace

TEST_CASE("time begins when all that are expected take part") {
  LockStep time(2);
  CHECK_FALSE(time.may_advance());
  time.hear(told("controller", 1));
  time.hear(told("controller", 1));
  CHECK_FALSE(time.may_advance());
  time.hear(told("navigator", 5));
  CHECK(time.may_advance());
  time.advance();
  CHECK(time.tick() == 0);
}

TEST_CASE(
    "a tick ends when all that are due at it have acknowledged it, and nobody else is awaited") {
  LockStep time(2);
  time.hear(told("controller", 1));
  time.hear(told("navigator", 5));
  time.advance();
  CHECK(time.awaited() == std::vector<std::string>{"controller", "navigator"});
  time.hear(told("navigator", 5, 0));
  CHECK_FALSE(time.may_advance());
  time.hear(told("controller", 1, 0));
  REQUIRE(time.may_advance());
  for (Tick tick = 1; tick < 5; ++tick) {
    time.advance();
    CHECK(time.awaited() == std::vector<std::string>{"controller"});
    time.hear(told("controller", 1, tick));
    REQUIRE(time.may_advance());
  }
  time.advance();
  CHECK(time.awaited().size() == 2);
}

TEST_CASE("an acknowledgment that comes twice, or late, does no harm") {
  LockStep time(1);
  time.hear(told("controller", 1));
  time.advance();
  time.hear(told("controller", 1, 0));
  time.advance();
  time.hear(told("controller", 1, 0));
  CHECK_FALSE(time.may_advance());
  time.hear(told("controller", 1, 1));
  time.hear(told("controller", 1, 0));
  CHECK(time.may_advance());
}

TEST_CASE("one that is no longer connected is out after so many looks, and time goes on") {
  constexpr int kLooks = 3;
  LockStep time(3);
  for (const char* name : {"controller", "navigator", "warner"}) time.hear(told(name, 1));
  time.advance();
  for (int look = 0; look < 10; ++look) CHECK(time.keep_connected(3, kLooks).empty());
  CHECK_FALSE(time.may_advance());  // it is slow, and there
  for (const char* name : {"controller", "navigator", "warner"}) time.hear(told(name, 1));
  for (int look = 0; look + 1 < kLooks; ++look) {
    CHECK(time.keep_connected(2, kLooks).empty());
    time.hear(told("controller", 1, 0));
    time.hear(told("warner", 1, 0));
  }
  CHECK(time.keep_connected(2, kLooks) == std::vector<std::string>{"navigator"});
  CHECK(time.may_advance());
}

TEST_CASE("who comes back joins at the present tick, and owes none of those before") {
  LockStep time(2);
  time.hear(told("controller", 1));
  time.hear(told("navigator", 5, -1, 1));
  for (Tick tick = 0; tick < 8; ++tick) {
    REQUIRE(time.may_advance());
    time.advance();
    time.hear(told("controller", 1, tick));
    time.hear(told("navigator", 5, tick));
  }
  time.hear(told("navigator", 5, -1, 2));  // its process has started anew
  CHECK(time.may_advance());
  for (Tick tick = 8; tick <= 10; ++tick) {
    REQUIRE(time.may_advance());
    time.advance();
    time.hear(told("controller", 1, tick));
  }
  CHECK(time.awaited() == std::vector<std::string>{"navigator"});
  time.hear(told("navigator", 5, 10, 2));
  CHECK(time.may_advance());
}

TEST_CASE("who leaves is not awaited; the farewell of a former life does not count") {
  LockStep time(1);
  time.hear(told("controller", 1, -1, 2));
  time.advance();
  Told farewell = told("controller", 1, -1, 1);
  farewell.leaves = true;
  time.hear(farewell);
  CHECK_FALSE(time.may_advance());
  farewell.life = 2;
  time.hear(farewell);
  CHECK(time.may_advance());
  CHECK(time.participants() == 0);
}

TEST_CASE("paused time stands, steps, and goes on") {
  Pace pace;
  CHECK(pace.next());
  pace.pause();
  CHECK_FALSE(pace.next());
  pace.step(2);
  REQUIRE(pace.next());
  pace.begin(Instant{} + 1s);
  REQUIRE(pace.next());
  pace.begin(Instant{} + 1s);
  CHECK_FALSE(pace.next());
  pace.resume();
  CHECK(pace.next());
}

TEST_CASE("a speed limit spaces the ticks, and what is late is made up for in part") {
  Pace pace(10);
  const Instant begin = Instant{} + 1h;
  pace.begin(begin);
  const Instant first = *pace.next();
  pace.begin(first);
  CHECK(*pace.next() - first == 2ms);
  pace.begin(first + 50ms);  // late by 48 ms: the following ones may hurry
  CHECK(*pace.next() < first + 50ms);
  pace.begin(first + 10s);
  CHECK(*pace.next() >= first + 10s - 100ms);
  pace.limit(0);
  CHECK(*pace.next() <= first + 10s);
}

}  // namespace clock_test
