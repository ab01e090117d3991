#include "skein/detail/circuit_breaker.hpp"

#include <catch2/catch.hpp>

using namespace skein;
using namespace std::chrono_literals;
using State = CircuitBreaker::State;

namespace {

const Instant kStart = Instant(1h);
const CircuitBreaker::Rules kRules{.faults = 3, .first_quarantine = 1s, .longest_quarantine = 5s};

CircuitBreaker opened(Instant when) {
  CircuitBreaker breaker(kRules);
  for (int i = 0; i < 3; ++i) breaker.fail(when);
  return breaker;
}

}  // namespace

TEST_CASE("a breaker opens at the third fault in a row") {
  CircuitBreaker breaker(kRules);
  breaker.fail(kStart);
  breaker.fail(kStart);
  CHECK(breaker.state(kStart) == State::Closed);
  breaker.fail(kStart);
  CHECK(breaker.state(kStart) == State::Open);
  CHECK(breaker.quarantine(kStart) == 1s);
}

TEST_CASE("a breaker that is tripped opens at once") {
  CircuitBreaker breaker(kRules);
  breaker.trip(kStart);
  CHECK(breaker.state(kStart) == State::Open);
  CHECK(breaker.quarantine(kStart) == 1s);
}

TEST_CASE("a success between faults keeps a breaker closed") {
  CircuitBreaker breaker(kRules);
  for (int i = 0; i < 5; ++i) {
    breaker.fail(kStart);
    breaker.fail(kStart);
    breaker.succeed();
  }
  CHECK(breaker.state(kStart) == State::Closed);
}

TEST_CASE("after its quarantine a breaker is half-open and takes one probe") {
  CircuitBreaker breaker = opened(kStart);
  CHECK(breaker.state(kStart + 999ms) == State::Open);
  CHECK(breaker.state(kStart + 1s) == State::HalfOpen);
  breaker.begin(kStart + 1s);
  CHECK(breaker.state(kStart + 1s) == State::Open);
  SECTION("that succeeds and closes it") {
    breaker.succeed();
    CHECK(breaker.state(kStart + 1s) == State::Closed);
  }
  SECTION("that fails and opens it for twice as long, up to the longest") {
    Instant now = kStart + 1s;
    for (const Duration quarantine : {2s, 4s, 5s, 5s}) {
      breaker.fail(now);
      CHECK(breaker.quarantine(now) == quarantine);
      now += quarantine;
      CHECK(breaker.state(now) == State::HalfOpen);
      breaker.begin(now);
    }
  }
  SECTION("that says nothing and leaves it half-open") {
    breaker.end();
    CHECK(breaker.state(kStart + 1s) == State::HalfOpen);
  }
}

TEST_CASE(
    "a breaker that has closed after a probe needs three faults again and begins with a short "
    "quarantine") {
  CircuitBreaker breaker = opened(kStart);
  breaker.begin(kStart + 1s);
  breaker.succeed();
  breaker.fail(kStart + 2s);
  breaker.fail(kStart + 2s);
  CHECK(breaker.state(kStart + 2s) == State::Closed);
  breaker.fail(kStart + 2s);
  CHECK(breaker.quarantine(kStart + 2s) == 1s);
}
