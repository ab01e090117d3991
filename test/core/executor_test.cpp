#include "skein/executor.hpp"

#include <pthread.h>

#include <algorithm>
#include <atomic>
#include <catch2/catch.hpp>
#include <condition_variable>
#include <functional>
#include <future>
#include <memory>
#include <mutex>
#include <thread>
#include <utility>

#include "core/threads/idle_work.hpp"
#include "skein/error.hpp"
#include "test/tools/eventually.hpp"

using namespace skein;
using namespace std::chrono_literals;
using skein::test::eventually;

namespace {

/// Holds up the executor's thread until opened.
class Gate {
 public:
  explicit Gate(Executor& executor) {
    executor.post([this] {
      closed_ = true;
      while (!open_) std::this_thread::yield();
    });
    REQUIRE(eventually([&] { return closed_.load(); }));
  }
  ~Gate() { open(); }
  void open() { open_ = true; }

 private:
  std::atomic<bool> closed_{false};
  std::atomic<bool> open_{false};
};

/// Goes on until it is over, or for as long as it is worth while.
struct WaitingWork final : IdleWork {
  void work_until(const std::function<bool()>& over) override {
    thread = std::this_thread::get_id();
    ++begun;
    const auto is_over = [&] { return over() || !worth_while; };
    std::unique_lock lock(mutex);
    called.wait(lock, [&] { return inside || is_over(); });
    if (!inside) return;
    const auto work = std::exchange(inside, nullptr);
    lock.unlock();
    work();
    lock.lock();
    called.wait(lock, is_over);
  }
  void wake() override {
    ++woken;
    { std::lock_guard lock(mutex); }
    called.notify_all();
  }

  std::mutex mutex;
  std::condition_variable called;
  std::function<void()> inside;  // what it does in it
  std::atomic<bool> worth_while{true};
  std::atomic<int> begun{0};
  std::atomic<int> woken{0};
  std::atomic<std::thread::id> thread;
};

}  // namespace

TEST_CASE("a thread that the system does not give is named, with the reason and the remedy") {
  pthread_attr_t usual, beyond;
  pthread_getattr_default_np(&usual);
  pthread_attr_init(&beyond);
  pthread_attr_setstacksize(&beyond, std::size_t{1} << 50);  // more than there are addresses
  pthread_setattr_default_np(&beyond);
  std::string text;
  try {
    ThreadExecutor executor("navigator");
  } catch (const Unavailable& error) {
    text = error.what();
  } catch (const std::exception& error) {
    text = std::string("another error: ") + error.what();
  }
  pthread_setattr_default_np(&usual);
  CHECK_THAT(text, Catch::StartsWith("the thread 'navigator' cannot be started: ") &&
                       Catch::Contains("Resource temporarily unavailable") &&
                       Catch::Contains("use fewer threads, or raise the limit"));
}

TEST_CASE("one thread runs tasks one after the other in order") {
  std::vector<int> seen;
  {
    ThreadExecutor executor("test");
    std::atomic<int> done = 0;
    for (int i = 0; i < 100; ++i) {
      executor.post([&, i] {
        seen.push_back(i);
        ++done;
      });
    }
    REQUIRE(eventually([&] { return done == 100; }));
  }
  REQUIRE(seen.size() == 100);
  CHECK(std::is_sorted(seen.begin(), seen.end()));
}

TEST_CASE("a full queue refuses tasks and keeps what it has") {
  ThreadExecutor executor("test", 1, 2);
  std::atomic<int> ran = 0;
  Gate gate(executor);
  CHECK(executor.post([&] { ++ran; }));
  CHECK(executor.post([&] { ++ran; }));
  CHECK_FALSE(executor.post([&] { ++ran; }));
  gate.open();
  CHECK(eventually([&] { return ran == 2; }));
}

TEST_CASE(
    "what must not be lost is queued beyond the limit, and runs here once the executor has "
    "stopped") {
  ThreadExecutor executor("test", 1, 1);
  std::atomic<int> ran = 0;
  Gate gate(executor);
  CHECK(executor.post([&] { ++ran; }));
  for (int i = 0; i < 100; ++i) executor.post_or_run([&] { ++ran; });
  CHECK(ran == 0);
  gate.open();
  CHECK(eventually([&] { return ran == 101; }));
  executor.stop();
  std::thread::id ran_on;
  executor.post_or_run([&] { ran_on = std::this_thread::get_id(); });
  CHECK(ran_on == std::this_thread::get_id());
}

TEST_CASE("an executor that finishes runs what was posted, and what that posts, before it stops") {
  ThreadExecutor executor("test");
  int ran = 0;
  std::function<void()> next = [&] {
    if (++ran < 100) executor.post(next);
  };
  executor.post(next);
  executor.finish();
  CHECK(ran == 100);
  CHECK_FALSE(executor.post([] {}));
}

TEST_CASE("stopping drops what has not begun and releases what it held") {
  auto executor = std::make_unique<ThreadExecutor>("test");
  auto held = std::make_shared<int>(1);
  const std::weak_ptr<int> watched = held;
  auto gate = std::make_unique<Gate>(*executor);
  executor->post([held = std::move(held)] { FAIL("dropped tasks do not run"); });
  std::thread opener([&] {
    eventually([&] { return watched.expired(); });
    gate->open();
  });
  executor->stop();
  opener.join();
  CHECK(watched.expired());
  CHECK_FALSE(executor->post([] {}));
}

TEST_CASE("a thread that is stuck is left behind in bounded time") {
  static std::atomic<bool> open = false;
  ThreadExecutor executor("test");
  std::atomic<bool> inside = false;
  executor.post([&] {
    inside = true;
    while (!open) std::this_thread::yield();
  });
  REQUIRE(eventually([&] { return inside.load(); }));
  CHECK_FALSE(executor.stop_or_abandon(10ms));
  open = true;
}

TEST_CASE("a thread without a task does its idle work, until there is one, or the end comes") {
  const auto work = std::make_shared<WaitingWork>();
  ThreadExecutor executor("test");
  executor.work_while_idle(work);
  std::atomic<int> ran{0};
  std::atomic<std::thread::id> thread;
  for (int i = 1; i <= 100; ++i) {
    executor.post([&] {
      thread = std::this_thread::get_id();
      ++ran;
    });
    REQUIRE(eventually([&] { return ran == i && work->begun >= i; }));
  }
  CHECK(work->thread.load() == thread.load());
  SECTION("a task that it makes itself needs no call") {
    const int woken = work->woken;
    {
      std::lock_guard lock(work->mutex);
      work->inside = [&] { executor.post([&] { ++ran; }); };
    }
    work->called.notify_all();
    CHECK(eventually([&] { return ran == 101; }));
    CHECK(work->woken == woken);
  }
  SECTION("where it is not worth while the thread sleeps") {
    work->worth_while = false;
    work->wake();
    const int begun = work->begun;
    executor.post([&] { ++ran; });
    CHECK(eventually([&] { return ran == 101 && work->begun <= begun + 1; }));
    executor.finish();
  }
  executor.stop();
  CHECK(work->begun >= 100);
}

TEST_CASE("a manual executor runs its tasks, and what they queue, when told") {
  ManualExecutor executor;
  int ran = 0;
  executor.post([&] {
    ++ran;
    executor.post([&] { ++ran; });
  });
  CHECK(ran == 0);
  CHECK(executor.run_all() == 2);
  CHECK(ran == 2);
}

TEST_CASE("a manual executor runs tasks as they come, until what they do is done") {
  ManualExecutor executor;
  std::atomic<int> ran = 0;
  const auto three = [&] { return ran == 3; };
  const auto begun = std::chrono::steady_clock::now();
  SECTION("its own thread runs them") {
    executor.post([&] { ++ran; });
    std::jthread other([&] {
      while (ran == 0) std::this_thread::yield();
      executor.post([&] { ++ran; });
      executor.post([&] { ++ran; });
    });
    CHECK(executor.run_until(begun + 1min, three));
  }
  SECTION("those that other threads have run count") {
    auto other = std::async(std::launch::async, [&] {
      for (int i = 0; i < 3; ++i) executor.post([&] { ++ran; });
      return executor.run_until(begun + 1min, three);
    });
    CHECK(executor.run_until(begun + 1min, three));
    CHECK(other.get());
  }
  SECTION("it ends in time without them") {
    executor.post([&] { ++ran; });
    CHECK_FALSE(executor.run_until(begun + 1ms, three));
    CHECK(ran == 1);
  }
}
