#include "core/stall_watch.hpp"

#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <catch2/catch.hpp>
#include <csignal>
#include <string>
#include <thread>
#include <vector>

#include "../tools/eventually.hpp"
#include "core/thread_stack.hpp"

using namespace skein;
using namespace std::chrono_literals;
using skein::test::eventually;

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

/// A thread that waits in the kernel until it is let go.
class WaitingThread {
 public:
  explicit WaitingThread(bool takes_signals = true) {
    REQUIRE(pipe(ends_) == 0);
    thread_ = std::thread([this, takes_signals] {
      sigset_t all;
      sigfillset(&all);
      if (!takes_signals) pthread_sigmask(SIG_BLOCK, &all, nullptr);
      number_ = gettid();
      char octet;
      while (read(ends_[0], &octet, 1) > 0) {
      }
    });
    REQUIRE(eventually([&] { return number_ != 0; }));
  }
  ~WaitingThread() {
    close(ends_[1]);
    thread_.join();
    close(ends_[0]);
  }
  pid_t number() const { return number_; }

 private:
  int ends_[2]{};
  std::atomic<pid_t> number_{0};
  std::thread thread_;
};

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

// TSan lets no handler run before the system call in which its thread waits has returned.
#ifndef __SANITIZE_THREAD__
TEST_CASE("the stack of a thread is seen while it waits, and it goes on waiting") {
  WaitingThread waiting;
  for (int i = 0; i < 3; ++i) {
    const auto functions = stack_of(waiting.number());
    CAPTURE(functions);
    const auto reads = std::ranges::find_if(
        functions, [](const std::string& function) { return function.starts_with("read ("); });
    CHECK(functions.end() - reads > 2);  // with who called it, and who called that one
  }
}

TEST_CASE("of a thread that has ended, or takes no signals, no stack is seen") {
  pid_t number = 0;
  {
    const WaitingThread waiting;
    number = waiting.number();
  }
  CHECK(stack_of(number).empty());
  CHECK(stack_of(WaitingThread(false).number()).empty());
  CHECK_FALSE(stack_of(WaitingThread().number()).empty());  // others are seen again
}
#endif
