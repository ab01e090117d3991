#include <pthread.h>
#include <signal.h>
#include <unistd.h>

#include <atomic>
#include <catch2/catch.hpp>
#include <condition_variable>
#include <future>
#include <mutex>
#include <thread>

#include "skein/error.hpp"
#include "skein/process.hpp"
#include "test/tools/eventually.hpp"

using namespace skein;
using skein::test::eventually;

namespace {

bool is_handled(int signal) {
  struct sigaction action {};
  ::sigaction(signal, nullptr, &action);
  return action.sa_handler != SIG_DFL && action.sa_handler != SIG_IGN;
}

void send(int signal) { REQUIRE(::kill(::getpid(), signal) == 0); }

/// Waits on a thread of its own, as a program may whose main thread does something else.
class Waiting {
 public:
  Waiting() : signal_(std::async(std::launch::async, wait_for_signal)) {
    REQUIRE(eventually([] { return is_handled(SIGTERM); }));
  }
  int signal() { return signal_.get(); }

 private:
  std::future<int> signal_;
};

/// What the process does about a signal, as it was before.
class Disposition {
 public:
  Disposition(int signal, void (*handler)(int))
      : signal_(signal), before_(::signal(signal, handler)) {}
  ~Disposition() { ::signal(signal_, before_); }
  Disposition(const Disposition&) = delete;
  Disposition& operator=(const Disposition&) = delete;

 private:
  const int signal_;
  void (*const before_)(int);
};

}  // namespace

TEST_CASE("a signal that asks to end wakes who waits for it, whichever thread receives it") {
  std::mutex mutex;
  std::condition_variable_any never;
  std::jthread other([&](const std::stop_token& end) {  // was there before, and blocks no signal
    std::unique_lock lock(mutex);
    never.wait(lock, end, [] { return false; });
  });
  const int signal = GENERATE(SIGTERM, SIGINT, SIGHUP);
  Waiting waiting;
  SECTION("the kernel chooses") { send(signal); }
  SECTION("a thread that was there before receives it") {
    ::pthread_kill(other.native_handle(), signal);
  }
  CHECK(waiting.signal() == signal);
}

TEST_CASE("a signal that all threads block, and that came before the wait, ends the wait at once") {
  sigset_t signals, before, after;
  sigemptyset(&signals);
  sigaddset(&signals, SIGTERM);
  ::pthread_sigmask(SIG_BLOCK, &signals, &before);
  send(SIGTERM);
  CHECK(wait_for_signal() == SIGTERM);
  ::pthread_sigmask(SIG_SETMASK, &before, &after);
  CHECK(sigismember(&after, SIGTERM));
}

TEST_CASE("a signal that is ignored does not end the wait") {
  const Disposition ignored(SIGINT, SIG_IGN);
  Waiting waiting;
  send(SIGINT);
  send(SIGTERM);
  CHECK(waiting.signal() == SIGTERM);
}

TEST_CASE("after the wait a signal does what it did before") {
  static std::atomic<int> own;
  own = 0;
  const Disposition handler(SIGTERM, [](int) { ++own; });
  auto signal = std::async(std::launch::async, wait_for_signal);
  REQUIRE(eventually([] { return is_handled(SIGINT); }));
  send(SIGTERM);
  CHECK(signal.get() == SIGTERM);
  CHECK(own == 0);
  CHECK_FALSE(is_handled(SIGINT));
  send(SIGTERM);
  CHECK(eventually([] { return own == 1; }));
}

TEST_CASE("each wait ends with a signal of its own") {
  for (int i = 0; i < 3; ++i) {
    Waiting waiting;
    send(SIGINT);
    CHECK(waiting.signal() == SIGINT);
  }
}

TEST_CASE("a second thread that would wait is refused, and the first one goes on") {
  Waiting waiting;
  CHECK_THROWS_AS(wait_for_signal(), InvalidArgument);
  send(SIGTERM);
  CHECK(waiting.signal() == SIGTERM);
}
