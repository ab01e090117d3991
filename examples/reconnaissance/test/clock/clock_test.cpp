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
  time.hear(told("controller", 1), Instant{});
  time.hear(told("controller", 1), Instant{});
  CHECK_FALSE(time.may_advance());
  time.hear(told("navigator", 5), Instant{});
  CHECK(time.may_advance());
  time.advance();
  CHECK(time.tick() == 0);
}

TEST_CASE(
    "a tick ends when all that are due at it have acknowledged it, and nobody else is awaited") {
  LockStep time(2);
  time.hear(told("controller", 1), Instant{});
  time.hear(told("navigator", 5), Instant{});
  time.advance();
  CHECK(time.awaited() == std::vector<std::string>{"controller", "navigator"});
  time.hear(told("navigator", 5, 0), Instant{});
  CHECK_FALSE(time.may_advance());
  time.hear(told("controller", 1, 0), Instant{});
  REQUIRE(time.may_advance());
  for (Tick tick = 1; tick < 5; ++tick) {
    time.advance();
    CHECK(time.awaited() == std::vector<std::string>{"controller"});
    time.hear(told("controller", 1, tick), Instant{});
    REQUIRE(time.may_advance());
  }
  time.advance();
  CHECK(time.awaited().size() == 2);
}

TEST_CASE("an acknowledgment that comes twice, or late, does no harm") {
  LockStep time(1);
  time.hear(told("controller", 1), Instant{});
  time.advance();
  time.hear(told("controller", 1, 0), Instant{});
  time.advance();
  time.hear(told("controller", 1, 0), Instant{});
  CHECK_FALSE(time.may_advance());
  time.hear(told("controller", 1, 1), Instant{});
  time.hear(told("controller", 1, 0), Instant{});
  CHECK(time.may_advance());
}

TEST_CASE("who is no longer connected is out, and time goes on; the silent one is it") {
  LockStep time(3);
  const Instant begin{};
  for (const char* name : {"controller", "navigator", "warner"}) time.hear(told(name, 1), begin);
  time.advance();
  time.hear(told("controller", 1, 0), begin + 1s);
  time.hear(told("warner", 1, 0), begin + 1s);
  CHECK(time.keep_connected(3, begin + 9s, 1s).empty());  // it is slow, and there
  CHECK_FALSE(time.may_advance());
  CHECK(time.keep_connected(2, begin + 900ms, 1s).empty());  // heard a moment ago
  CHECK(time.keep_connected(2, begin + 1s, 1s) == std::vector<std::string>{"navigator"});
  CHECK(time.may_advance());
}

TEST_CASE("who comes back joins at the present tick, and owes none of those before") {
  LockStep time(2);
  time.hear(told("controller", 1), Instant{});
  time.hear(told("navigator", 5, -1, 1), Instant{});
  for (Tick tick = 0; tick < 8; ++tick) {
    REQUIRE(time.may_advance());
    time.advance();
    time.hear(told("controller", 1, tick), Instant{});
    time.hear(told("navigator", 5, tick), Instant{});
  }
  time.hear(told("navigator", 5, -1, 2), Instant{});  // its process has started anew
  CHECK(time.may_advance());
  for (Tick tick = 8; tick <= 10; ++tick) {
    REQUIRE(time.may_advance());
    time.advance();
    time.hear(told("controller", 1, tick), Instant{});
  }
  CHECK(time.awaited() == std::vector<std::string>{"navigator"});
  time.hear(told("navigator", 5, 10, 2), Instant{});
  CHECK(time.may_advance());
}

TEST_CASE("who leaves is not awaited; the farewell of a former life does not count") {
  LockStep time(1);
  time.hear(told("controller", 1, -1, 2), Instant{});
  time.advance();
  Told farewell = told("controller", 1, -1, 1);
  farewell.leaves = true;
  time.hear(farewell, Instant{});
  CHECK_FALSE(time.may_advance());
  farewell.life = 2;
  time.hear(farewell, Instant{});
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
