#include "rpc/wire/transit_delay.hpp"

#include <catch2/catch.hpp>

using namespace skein;
using namespace skein::rpc;
using namespace std::chrono_literals;

namespace {

/// A sender and a receiver, each with a clock of its own, 3 ms apart.
struct Path {
  ManualClock here;
  Duration senders_clock = 90h;
  TransitDelay delay;

  /// Time passes, at the sender's by `drift` more.
  void pass(Duration time, Duration drift = {}) {
    here.advance(time);
    senders_clock += time + drift;
  }
  Duration excess_of(Duration waited) {
    return delay.excess(senders_clock - waited - 3ms, here.now());
  }
};

}  // namespace

TEST_CASE("a sender's first message is as late as is usual, whatever its clock says") {
  Path path;
  CHECK(path.excess_of(7h) == 0ms);
}

TEST_CASE("what a message waited beyond the least time that one took is its excess") {
  Path path;
  CHECK(path.excess_of(5ms) == 0ms);
  CHECK(path.excess_of(0ms) == 0ms);
  CHECK(path.excess_of(5ms) == 5ms);
  CHECK(path.excess_of(2s) == 2s);
  path.pass(1s);
  CHECK(path.excess_of(200ms) == 199ms);
}

TEST_CASE(
    "what arrives at once after a stop is compared with what came before it, however long that "
    "was") {
  const Duration stop = GENERATE(as<Duration>{}, 1s, 10s, 30s);
  Path path;
  path.excess_of(0ms);
  path.pass(stop);
  for (Duration waited = stop; waited > 100ms; waited -= 100ms) {
    CHECK(path.excess_of(waited) >= waited - stop / 500);
  }
  path.pass(1ms);
  CHECK(path.excess_of(0ms) == 0ms);
}

TEST_CASE("clocks that drift apart make no message late") {
  const Duration drift = GENERATE(as<Duration>{}, -1ms, 1ms);
  const Duration pause = GENERATE(as<Duration>{}, 1s, 60s);
  Path path;
  for (Duration passed{}; passed < 1h; passed += pause) {
    REQUIRE(path.excess_of(0ms) == 0ms);
    path.pass(pause, drift * (pause / 1s));
  }
}

TEST_CASE("a sender's clock that jumped is learnt anew") {
  Path path;
  path.excess_of(0ms);
  path.senders_clock -= 5s;
  CHECK(path.excess_of(0ms) == 5s);
  for (int second = 0; second < 20; ++second) {
    path.pass(1s);
    path.excess_of(0ms);
  }
  CHECK(path.excess_of(0ms) == 0ms);
  path.senders_clock += 5s;
  CHECK(path.excess_of(0ms) == 0ms);
}
