#include "skein/core/executor.hpp"

#include <algorithm>
#include <atomic>
#include <catch2/catch.hpp>
#include <memory>
#include <thread>

#include "../tools/eventually.hpp"
#include "../tools/parked_threads.hpp"
#include "skein/core/worker.hpp"

using namespace skein;
using namespace std::chrono_literals;
using skein::test::eventually;
using skein::test::parked_threads;

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

/// Work on one of the executor's threads that stays exposed until it is released. What its thread
/// touches stays for the rest of the process's life.
class Exposed {
 public:
  explicit Exposed(Executor& executor) {
    executor.post([shared = shared_] {
      shared->worker = ThreadExecutor::worker();
      shared->worker.load()->expose();
      shared->inside = true;
      while (!shared->released) std::this_thread::yield();
      shared->worker.load()->cover();
      shared->went_on = true;
    });
    REQUIRE(eventually([&] { return shared_->inside.load(); }));
  }
  ~Exposed() { release(); }
  bool write_off() { return shared_->worker.load()->write_off(); }
  void release() { shared_->released = true; }
  bool went_on() const { return shared_->went_on; }

 private:
  struct Shared {
    std::atomic<Worker*> worker{nullptr};
    std::atomic<bool> inside{false};
    std::atomic<bool> released{false};
    std::atomic<bool> went_on{false};
  };
  const std::shared_ptr<Shared> shared_ = std::make_shared<Shared>();
};

}  // namespace

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

TEST_CASE("an idle executor runs a task on the calling thread, a busy one does not") {
  ThreadExecutor executor("test");
  std::thread::id ran_on;
  CHECK(executor.try_run_inline([&] {
    ran_on = std::this_thread::get_id();
    CHECK(executor.runs_here());
    CHECK_FALSE(executor.try_run_inline([] {}));
  }));
  CHECK(ran_on == std::this_thread::get_id());
  CHECK_FALSE(executor.runs_here());
  Gate gate(executor);
  CHECK_FALSE(executor.try_run_inline([] {}));
}

TEST_CASE("a task that is posted while one runs inline runs afterwards") {
  ThreadExecutor executor("test");
  std::atomic<bool> ran = false;
  std::atomic<bool> overlapped = false;
  executor.try_run_inline([&] {
    executor.post([&] { ran = true; });
    std::this_thread::yield();
    overlapped = ran.load();
  });
  CHECK(eventually([&] { return ran.load(); }));
  CHECK_FALSE(overlapped);
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

TEST_CASE("a worker that is written off is replaced, and what it ran never goes on") {
  const auto parked = parked_threads();
  ThreadExecutor executor("test");
  std::atomic<int> ran = 0;
  Exposed stuck(executor);
  CHECK_FALSE(executor.try_run_inline([] {}));
  CHECK(stuck.write_off());
  CHECK_FALSE(stuck.write_off());
  for (int i = 0; i < 3; ++i) executor.post([&] { ++ran; });
  CHECK(eventually([&] { return ran == 3; }));
  CHECK(eventually([&] { return executor.try_run_inline([] {}); }));
  stuck.release();
  CHECK(eventually([&] { return parked_threads() == parked + 1; }));
  CHECK_FALSE(stuck.went_on());
}

TEST_CASE("a worker whose work has come back is not written off") {
  ThreadExecutor executor("test");
  Exposed quick(executor);
  quick.release();
  REQUIRE(eventually([&] { return quick.went_on(); }));
  CHECK_FALSE(quick.write_off());
}

TEST_CASE("an executor ends although a worker was written off, before or while it ends") {
  const auto parked = parked_threads();
  ThreadExecutor executor("test");
  Exposed stuck(executor);
  SECTION("before") {
    stuck.write_off();
    executor.stop();
  }
  SECTION("while") {
    std::thread other([&] {
      eventually([&] { return !executor.post([] {}); });
      stuck.write_off();
    });
    executor.stop();
    other.join();
  }
  stuck.release();
  CHECK(eventually([&] { return parked_threads() == parked + 1; }));
  CHECK_FALSE(stuck.went_on());
}

TEST_CASE("what a thread that was left behind ran never goes on either") {
  const auto parked = parked_threads();
  ThreadExecutor executor("test");
  Exposed stuck(executor);
  CHECK_FALSE(executor.stop_or_abandon(10ms));
  CHECK_FALSE(stuck.write_off());
  stuck.release();
  CHECK(eventually([&] { return parked_threads() == parked + 1; }));
  CHECK_FALSE(stuck.went_on());
}

TEST_CASE("a thread is an executor's worker only while it runs that executor's own task") {
  ThreadExecutor executor("test"), other("other");
  CHECK(ThreadExecutor::worker() == nullptr);
  std::atomic<bool> done = false;
  Worker* own = nullptr;
  Worker* within = nullptr;
  executor.post([&] {
    own = ThreadExecutor::worker();
    other.try_run_inline([&] { within = ThreadExecutor::worker(); });
    done = true;
  });
  REQUIRE(eventually([&] { return done.load(); }));
  CHECK(own != nullptr);
  CHECK(within == nullptr);
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
