#include "core/clock_wait.hpp"

#include <atomic>
#include <catch2/catch.hpp>
#include <stdexcept>
#include <thread>

#include "test/tools/eventually.hpp"

using namespace skein;
using namespace std::chrono_literals;
using skein::test::eventually;

namespace {

/// Opened by one thread, waited for by another.
class Door {
 public:
  bool await(Clock& clock, Instant deadline) {
    std::unique_lock lock(mutex_);
    return wait_until(clock, deadline, lock, changed_, [&] {
      ++looks;
      return open_;
    });
  }
  void open() {
    std::lock_guard lock(mutex_);
    open_ = true;
    changed_.notify_all();
  }

  std::atomic<int> looks{0};  // the second comes once the wait has begun

 private:
  std::mutex mutex_;
  std::condition_variable changed_;
  bool open_ = false;
};

}  // namespace

TEST_CASE("a wait ends when what it is for has come, though time stands still") {
  ManualClock clock;
  Door door;
  bool came = false;
  std::thread waiting([&] { came = door.await(clock, clock.now() + 1h); });
  const bool waits = eventually([&] { return door.looks >= 2; });
  door.open();
  waiting.join();
  CHECK(waits);
  CHECK(came);
}

TEST_CASE("a wait in vain ends at its deadline, by its own clock") {
  ManualClock clock;
  Door door;
  const Instant deadline = clock.now() + 1h;
  std::atomic<bool> ended = false;
  bool came = true;
  std::thread waiting([&] {
    came = door.await(clock, deadline);
    ended = true;
  });
  const bool waits = eventually([&] { return door.looks >= 2; });
  clock.advance(59min);
  CHECK_FALSE(ended);
  clock.advance(1min);
  waiting.join();
  CHECK(waits);
  CHECK_FALSE(came);
}

TEST_CASE("a wait whose deadline has passed looks once") {
  ManualClock clock;
  Door door;
  CHECK_FALSE(door.await(clock, clock.now()));
  door.open();
  CHECK(door.await(clock, clock.now()));
}

TEST_CASE("waits that end at their deadline and by a notification at once leave nothing behind") {
  SystemClock clock;
  for (int round = 0; round < 200; ++round) {
    Door door;
    std::thread waiting([&] { door.await(clock, clock.now() + 200us); });
    std::this_thread::yield();
    door.open();
    waiting.join();
  }
}

TEST_CASE("what a wait's condition throws comes through, with the lock held and no timer set") {
  ManualClock clock;
  bool woken = false;
  {
    std::mutex mutex;
    std::condition_variable changed;
    std::unique_lock lock(mutex);
    int asked = 0;
    const auto throws_when_waiting = [&]() -> bool {
      if (++asked > 1) throw std::runtime_error("no answer");
      return false;
    };
    CHECK_THROWS_WITH(wait_until(clock, clock.now() + 1h, lock, changed, throws_when_waiting),
                      "no answer");
    CHECK(lock.owns_lock());
  }
  clock.call_after(2h, [&] { woken = true; });
  clock.advance(2h);  // would touch the mutex that has gone
  CHECK(woken);
}
