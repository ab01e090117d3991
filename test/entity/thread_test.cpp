#include <catch2/catch.hpp>

#include "office.hpp"
#include "test/tools/log.hpp"

using namespace skein;
using namespace skein::test;
using namespace std::chrono_literals;

namespace {

/// A CSP with its owner, which notes the thread that it runs on.
struct Noted {
  Noted(Office& office, ServiceOptions options) {
    office.add(
        "noted", Place::Inside,
        [this](const std::string& task) {
          thread = std::this_thread::get_id();
          return "noted did " + task;
        },
        options);
  }
  std::atomic<std::thread::id> thread;
};

ServiceOptions on(CallThread thread) {
  ServiceOptions options = declared("1", "0.9");
  options.thread = thread;
  return options;
}

WorkTask blocking_task() {
  WorkTask task = Office::task();
  task.run = [](crew::Worker::Proxy& worker, Duration) { return worker.work("it"); };
  return task;
}

}  // namespace

TEST_CASE_METHOD(Office, "a CSP runs on its own thread unless it declares its caller's") {
  const Noted noted(*this, declared("1", "0.9"));
  CHECK(perform(blocking_task(), 60s) == "noted did it");
  CHECK(noted.thread.load() != std::this_thread::get_id());
}

TEST_CASE_METHOD(Office,
                 "a CSP that declares its caller's thread runs there, however long it takes") {
  const Noted noted(*this, on(CallThread::Caller));
  for (int i = 0; i < 20; ++i) {
    CHECK(perform(blocking_task(), 60s) == "noted did it");
    CHECK(noted.thread.load() == std::this_thread::get_id());
  }

  SECTION("but for an asynchronous call, which cannot") {
    CHECK(perform(Office::task(), 60s) == "noted did it");
    CHECK(noted.thread.load() != std::this_thread::get_id());
  }
}

TEST_CASE_METHOD(Office, "calls that run on their callers' threads run one at a time") {
  std::atomic<int> inside = 0;
  std::atomic<int> together = 0;
  add(
      "alone", Place::Inside,
      [&](const std::string& task) {
        if (++inside > 1) ++together;
        std::this_thread::yield();
        --inside;
        return "alone did " + task;
      },
      on(CallThread::Caller));
  std::vector<std::thread> callers;
  for (int i = 0; i < 4; ++i) {
    callers.emplace_back([&, asynchronous = i % 2 == 1] {
      const WorkTask task = asynchronous ? Office::task() : blocking_task();
      for (int j = 0; j < 50; ++j) owner->head().perform(task, nullptr, 60s);
    });
  }
  for (std::thread& caller : callers) caller.join();
  CHECK(together == 0);
}

TEST_CASE_METHOD(Office, "whose turn does not come by the deadline is told so, and nothing hangs") {
  Hang hang;
  auto busy = add("busy", Place::Inside, hang.script(), on(CallThread::Caller));
  std::thread other(
      [&] { CHECK(owner->head().perform(blocking_task(), nullptr, 60s) == "too late"); });
  const bool entered = eventually([&] { return busy->inside == 1; });
  auto proxy = owner->head().preselect<crew::Worker>({}, 100ms);
  CHECK_THROWS_AS(proxy.work("it"), TimedOut);
  CHECK(busy->inside == 1);
  hang.release();
  other.join();
  CHECK(entered);
}

TEST_CASE_METHOD(Office, "a service that runs on its callers' threads has one thread of its own") {
  ServiceOptions options = on(CallThread::Caller);
  options.threads = 2;
  CHECK_THROWS_WITH(add("many", Place::Inside, answer_as("many"), options),
                    Catch::Contains("one call at a time") && Catch::Contains("2 threads"));
}

TEST_CASE("an entity ends once the calls that run on others' threads have ended") {
  auto office = std::make_unique<Office>();
  Hang hang;
  const auto busy = office->add("busy", Place::Inside, hang.script(), on(CallThread::Caller));
  auto proxy = office->owner->head().preselect<crew::Worker>({}, 60s);
  std::string result;
  std::thread caller([&] { result = proxy.work("it"); });
  const bool entered = eventually([&] { return busy->inside == 1; });
  std::atomic<bool> ended = false;
  std::thread ending([&] {
    office.reset();
    ended = true;
  });
  // What comes now is refused, so the end has begun.
  const bool begun = eventually([&] {
    try {
      proxy.within(10ms).work("it");
    } catch (const TimedOut&) {
      return false;
    } catch (const Error&) {
      return true;
    }
    return false;
  });
  CHECK_FALSE(ended);
  hang.release();
  caller.join();
  ending.join();
  CHECK(entered);
  CHECK(begun);
  CHECK(result == "too late");
  CHECK(busy->calls == 1);
}

TEST_CASE_METHOD(Office, "whoever waits for a turn is refused when the service is withdrawn") {
  Hang hang;
  const auto busy = add("busy", Place::Inside, hang.script(), on(CallThread::Caller));
  auto proxy = owner->head().preselect<crew::Worker>({}, 60s);
  std::thread first([&] { proxy.work("it"); });
  const bool entered = eventually([&] { return busy->inside == 1; });
  auto second = proxy.async_work("it");  // waits on the service's own thread
  std::thread withdrawing([&] { remove("busy"); });
  CHECK_THROWS_AS(second.get(), Error);
  hang.release();
  first.join();
  withdrawing.join();
  CHECK(entered);
  CHECK(busy->calls == 1);
}

TEST_CASE_METHOD(
    Office, "a CSP that hangs on its caller's thread is told of at once, while its caller waits") {
  const Log log;
  Hang hang;
  add("busy", Place::Inside, hang.script(), on(CallThread::Caller));
  constexpr auto kLimit = 50ms;
  const auto begun = std::chrono::steady_clock::now();
  std::thread caller(
      [&] { CHECK_THROWS_AS(owner->head().perform(blocking_task(), nullptr, kLimit), TimedOut); });
  CHECK(eventually([&] {
    return log.count(
               "uav-1/office: CSP 'busy' has not returned from a request whose time is over; "
               "it runs on its caller's thread, which waits for it: give it a thread of its "
               "own (CallThread::Own)") == 1;
  }));
  // It is told at the end of its slice, which is a little before that of the limit.
  CHECK(eventually([&] { return std::chrono::steady_clock::now() > begun + 2 * kLimit; }));
  hang.release();
  caller.join();
}
