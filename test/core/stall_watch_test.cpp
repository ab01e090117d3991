#include "core/threads/stall_watch.hpp"

#include <catch2/catch.hpp>
#include <string>
#include <vector>

using namespace skein;
using namespace std::chrono_literals;

namespace {

/// A watch in invented time, and what it has told.
struct Watched {
  /// So many looks, each a period after the last.
  void look(int times, Duration apart = StallWatch::kPeriod) {
    for (; times > 0; --times) watch.look(now += apart);
  }

  std::vector<std::string> told;
  StallWatch watch{[this](const std::string& name, pid_t) { told.push_back(name); }};
  WatchedThread thread{"one", watch};
  Instant now{1h};
};

using Names = std::vector<std::string>;

}  // namespace

TEST_CASE("a thread that is within one piece of work for a second is told of, once") {
  Watched watched;
  watched.thread.begin();
  watched.look(StallWatch::kLooks);
  CHECK(watched.told.empty());
  watched.look(1);
  CHECK(watched.told == Names{"one"});
  watched.look(1000);
  CHECK(watched.told == Names{"one"});
  watched.thread.end();
}

TEST_CASE("a thread that ends its pieces, however many, or that has none, is not told of") {
  Watched watched;
  watched.look(10);
  for (int i = 0; i < 10; ++i) {
    watched.thread.begin();
    watched.look(StallWatch::kLooks);
    watched.thread.end();
  }
  CHECK(watched.told.empty());
}

TEST_CASE("what comes within a minute of a thread that was told of is not told") {
  Watched watched;
  const auto stall = [&] {
    watched.thread.begin();
    watched.look(StallWatch::kLooks + 1);
    watched.thread.end();
  };
  stall();
  stall();
  CHECK(watched.told.size() == 1);
  watched.look(StallWatch::kQuietLooks);
  stall();
  CHECK(watched.told.size() == 2);
}

TEST_CASE("neither a clock that jumps, nor a process that was stopped, is a stall") {
  Watched watched;
  watched.thread.begin();
  SECTION("an hour has passed, now and then") {
    for (int i = 0; i < 10; ++i) {
      watched.look(StallWatch::kLooks - 1);
      watched.look(1, 1h);
      CHECK(watched.told.empty());
    }
  }
  SECTION("many look, at almost the same time") { watched.look(1000, 1us); }
  SECTION("time goes back") {
    watched.look(StallWatch::kLooks);
    watched.look(100, -1h);
  }
  CHECK(watched.told.empty());
  watched.thread.end();
}

TEST_CASE("who looks is told when to look next, whoever looked last") {
  Watched watched;
  CHECK(watched.watch.look(watched.now) == StallWatch::kPeriod);
  CHECK(watched.watch.look(watched.now + 100ms) == StallWatch::kPeriod - 100ms);
  CHECK(watched.watch.look(watched.now + StallWatch::kPeriod - 1us) == 1ms);
  CHECK(watched.watch.look(watched.now + StallWatch::kPeriod) == StallWatch::kPeriod);
}

TEST_CASE("who has ended is not looked at") {
  Watched watched;
  {
    WatchedThread other("other", watched.watch);
    other.begin();
    watched.look(StallWatch::kLooks);
  }
  watched.look(5);
  CHECK(watched.told.empty());
}
