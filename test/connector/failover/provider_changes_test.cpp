#include "connector/provider_changes.hpp"

#include <catch2/catch.hpp>
#include <future>

using namespace skein;
using namespace skein::connector;
using namespace std::chrono_literals;

namespace {

struct Waiting {
  bool await_in_time(std::uint64_t seen) { return changes.await(seen, deadline); }

  ManualClock clock;
  const Instant deadline = clock.now() + 10s;
  ManualExecutor continuations;
  ProviderChanges changes{clock, continuations};
};

}  // namespace

TEST_CASE_METHOD(Waiting, "a change that came after the last look ends the wait at once") {
  const std::uint64_t seen = changes.count();
  changes.on_change();
  CHECK(changes.count() == seen + 1);
  CHECK(await_in_time(seen));
  CHECK(changes.tell(seen, {}));
  CHECK(continuations.run_all() == 1);
}

TEST_CASE_METHOD(Waiting, "a caller waits for a change until its deadline, or the end") {
  auto waits = std::async(std::launch::async, [&] { return await_in_time(0); });
  SECTION("a change") {
    changes.on_change();
    CHECK(waits.get());
  }
  SECTION("the deadline") {
    clock.advance(10s);
    CHECK_FALSE(waits.get());
  }
  SECTION("the end") {
    changes.close();
    CHECK_FALSE(waits.get());
  }
}

TEST_CASE_METHOD(Waiting, "a call without a thread looks in a task, once for a change") {
  const std::uint64_t seen = changes.count();
  CHECK(changes.tell(seen, {}));
  CHECK(continuations.run_all() == 0);
  changes.on_change();
  CHECK(continuations.run_all() == 1);
  changes.on_change();
  CHECK(continuations.run_all() == 0);
}

TEST_CASE_METHOD(Waiting, "at the end all calls look, and none waits any more") {
  CHECK(changes.tell(changes.count(), {}));
  changes.close();
  CHECK(continuations.run_all() == 1);
  CHECK_FALSE(changes.tell(changes.count(), {}));
  CHECK_FALSE(await_in_time(changes.count()));
}

TEST_CASE_METHOD(Waiting, "what reports changes is kept until the end, and not after it") {
  const auto source = std::make_shared<int>();
  changes.follow(source);
  CHECK(source.use_count() == 2);
  changes.close();
  CHECK(source.use_count() == 1);
  changes.follow(source);
  CHECK(source.use_count() == 1);
}
