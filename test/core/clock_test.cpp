#include "skein/clock.hpp"

#include <unistd.h>

#include <atomic>
#include <catch2/catch.hpp>
#include <fstream>
#include <string>
#include <thread>
#include <vector>

#include "test/tools/eventually.hpp"

using namespace skein;
using namespace std::chrono_literals;
using skein::test::eventually;

namespace {

/// Of a thread of this process.
std::string status_of(pid_t thread, const std::string& name) {
  std::ifstream status("/proc/self/task/" + std::to_string(thread) + "/status");
  std::string value;
  for (std::string word; status >> word;) {
    if (word == name + ":") status >> value;
  }
  return value;
}

/// How often it has gone to sleep until now, when it sleeps.
int sleeps_of(pid_t thread) {
  REQUIRE(eventually([&] { return status_of(thread, "State") == "S"; }));
  return std::stoi(status_of(thread, "voluntary_ctxt_switches"));
}

}  // namespace

static_assert(saturating_sum(Duration(1), Duration(2)) == Duration(3));
static_assert(saturating_sum(Duration::max(), 1ns) == Duration::max());
static_assert(saturating_sum(Duration::min(), -1ns) == Duration::min());
static_assert(saturating_sum(Instant(1h), Duration::max()) == Instant::max());
static_assert(saturating_sum(Instant(1h), std::chrono::hours::max()) == Instant::max());
static_assert(saturating_duration(1500ms) == 1'500'000us);
static_assert(saturating_duration(std::chrono::milliseconds::max()) == Duration::max());
static_assert(saturating_duration(std::chrono::milliseconds::min()) == Duration::min());
static_assert(saturating_duration(std::chrono::duration<double>(1e300)) == Duration::max());

TEST_CASE("a timer that is set for longer than the clock counts is not due before that") {
  ManualClock clock;
  int ran = 0;
  clock.call_after(Duration::max(), [&] { ++ran; });
  clock.advance(24h * 365 * 200);
  CHECK(ran == 0);
  clock.advance(Duration::max());
  CHECK(ran == 1);
}

TEST_CASE("a manual clock stands still until it is told") {
  ManualClock clock;
  const Instant begin = clock.now();
  CHECK(clock.now() == begin);
  clock.advance(3s);
  CHECK(clock.now() == begin + 3s);
}

TEST_CASE("a manual clock runs timers in the order of their instants, each at its own") {
  ManualClock clock;
  const Instant begin = clock.now();
  std::vector<Duration> seen;
  clock.call_after(2s, [&] { seen.push_back(clock.now() - begin); });
  clock.call_after(1s, [&] {
    seen.push_back(clock.now() - begin);
    clock.call_after(500ms, [&] { seen.push_back(clock.now() - begin); });
  });
  clock.advance(10s);
  CHECK(seen == std::vector<Duration>{1s, 1500ms, 2s});
}

TEST_CASE("a cancelled timer does not run") {
  ManualClock clock;
  int ran = 0;
  const TimerId timer = clock.call_after(1s, [&] { ++ran; });
  clock.cancel(timer);
  clock.cancel(timer);
  clock.cancel(0);
  clock.advance(2s);
  CHECK(ran == 0);
}

TEST_CASE("the system clock runs an earlier timer first even when it was set later") {
  SystemClock clock;
  std::atomic<bool> late = false;
  std::atomic<bool> soon = false;
  clock.call_after(10min, [&] { late = true; });
  clock.call_after(1ms, [&] { soon = true; });
  CHECK(eventually([&] { return soon.load(); }));
  CHECK_FALSE(late);
}

TEST_CASE("timers that are set and cancelled one after another do not wake the clock's thread") {
  SystemClock clock;
  std::atomic<pid_t> thread = 0;
  clock.call_after(0ms, [&] { thread = ::gettid(); });
  REQUIRE(eventually([&] { return thread != 0; }));
  clock.cancel(clock.call_after(10min, [] {}));
  const int before = sleeps_of(thread);
  for (int i = 0; i < 10; ++i) {
    clock.cancel(clock.call_after(10min, [] {}));
    CHECK(sleeps_of(thread) == before);
  }

  std::atomic<bool> soon = false;
  clock.call_after(1ms, [&] { soon = true; });
  CHECK(eventually([&] { return soon.load(); }));
}

TEST_CASE("after cancel has returned a timer's action is over, also when it was running") {
  SystemClock clock;
  std::atomic<bool> entered = false;
  std::atomic<bool> release = false;
  std::atomic<bool> left = false;
  const TimerId timer = clock.call_after(0ms, [&] {
    entered = true;
    while (!release) {
    }
    left = true;
  });
  REQUIRE(eventually([&] { return entered.load(); }));
  release = true;
  clock.cancel(timer);
  CHECK(left);
}

TEST_CASE("a manual clock's cancel, too, waits for an action that runs on another thread") {
  ManualClock clock;
  std::atomic<bool> entered = false;
  std::atomic<bool> release = false;
  std::atomic<bool> left = false;
  const TimerId timer = clock.call_after(1s, [&] {
    entered = true;
    while (!release) std::this_thread::yield();
    left = true;
  });
  std::thread advancing([&] { clock.advance(1s); });
  CHECK(eventually([&] { return entered.load(); }));
  release = true;
  clock.cancel(timer);
  CHECK(left);
  advancing.join();
}

TEST_CASE("a manual clock's timer may cancel itself") {
  ManualClock clock;
  TimerId timer = 0;
  bool done = false;
  timer = clock.call_after(1s, [&] {
    clock.cancel(timer);
    done = true;
  });
  clock.advance(1s);
  CHECK(done);
}

TEST_CASE("a timer may cancel itself") {
  SystemClock clock;
  std::atomic<TimerId> timer = 0;
  std::atomic<bool> done = false;
  timer = clock.call_after(20ms, [&] {
    clock.cancel(timer);
    done = true;
  });
  CHECK(eventually([&] { return done.load(); }));
}

TEST_CASE("a timer may be the last to let go of its clock") {
  auto clock = std::make_shared<SystemClock>();
  const std::weak_ptr<SystemClock> watched = clock;
  std::atomic<bool> alone = false;
  clock->call_after(0ms, [&alone, owned = clock] {
    while (!alone) std::this_thread::yield();
  });
  clock.reset();
  alone = true;
  CHECK(eventually([&] { return watched.expired(); }));
}
