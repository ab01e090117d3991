#include "skein/call_context.hpp"

#include <atomic>
#include <catch2/catch.hpp>

using namespace skein;
using namespace std::chrono_literals;

TEST_CASE("a call on another's thread hears that nobody waits for that one") {
  ManualClock clock;
  const Instant soon = clock.now() + 1s;
  const Instant later = clock.now() + 10s;
  std::atomic<bool> outermost_cancelled{false};
  std::atomic<bool> inner_cancelled{false};
  const CallContext outermost(clock, soon, {}, {}, nullptr, &outermost_cancelled);
  const CallContext outer(clock, later, {}, {&outermost}, nullptr, nullptr);
  const CallContext inner(clock, later, {}, {&outer}, nullptr, &inner_cancelled);
  CHECK_FALSE(inner.cancelled());
  SECTION("as it was cancelled") { outermost_cancelled = true; }
  SECTION("as its deadline has passed") { clock.advance(1s); }
  CHECK(inner.cancelled());
  CHECK(outer.cancelled());
}

TEST_CASE("a call hears nothing of one that it makes in turn") {
  ManualClock clock;
  std::atomic<bool> inner_cancelled{true};
  const CallContext outer(clock, clock.now() + 1s, {}, {}, nullptr, nullptr);
  const CallContext inner(clock, clock.now() + 1s, {}, {&outer}, nullptr, &inner_cancelled);
  CHECK(inner.cancelled());
  CHECK_FALSE(outer.cancelled());
}
