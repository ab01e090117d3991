#include <atomic>
#include <catch2/catch.hpp>
#include <functional>
#include <memory>
#include <thread>
#include <vector>

#include "skein/detail/channel.hpp"
#include "skein/error.hpp"

using namespace skein;

namespace {

const OperationInfo kOperation{"probe", 1, 1, false, false, false, nullptr, nullptr, {}, ""};

std::shared_ptr<PendingCall> a_call() {
  return std::make_shared<PendingCall>(kOperation, nullptr, Instant{}, true);
}

/// Of a connection: `bring` says what comes while a thread that waits takes them.
struct Incoming final : Answers {
  void take_until(const std::atomic<bool>& finished) override {
    ++taken;
    bring();
    ended = finished.load();
  }
  void wake() override { ++woken; }
  void begin(bool blocking) override {
    CHECK(blocking);
    ++calls;
  }
  void end() override { --calls; }
  void attend() override { ++attended; }
  void leave() override { --attended; }

  std::function<void()> bring = [] {};
  std::atomic<int> taken{0};
  std::atomic<int> woken{0};
  std::atomic<int> calls{0};
  std::atomic<int> attended{0};
  bool ended = false;
};

/// One whose answer its caller can take, and from where.
struct Asked {
  Asked() { call->set_answers(incoming); }
  void answer() {
    REQUIRE(call->claim());
    call->finish();
  }

  const std::shared_ptr<Incoming> incoming = std::make_shared<Incoming>();
  const std::shared_ptr<PendingCall> call = a_call();
};

}  // namespace

TEST_CASE("of many who end a call exactly one succeeds") {
  for (int round = 0; round < 200; ++round) {
    const auto call = a_call();
    std::atomic<int> winners = 0;
    std::vector<std::thread> threads;
    for (int i = 0; i < 4; ++i) {
      threads.emplace_back(
          [&] { winners += call->fail(std::make_exception_ptr(TimedOut("late"))); });
    }
    call->wait();
    for (std::thread& thread : threads) thread.join();
    CHECK(winners == 1);
  }
}

TEST_CASE("a call's continuation runs once, whether set before or after the end") {
  const auto early = a_call();
  int ran = 0;
  early->on_finished([&] { ++ran; });
  CHECK(ran == 0);
  REQUIRE(early->claim());
  early->finish();
  CHECK(ran == 1);
  CHECK_FALSE(early->take_error());

  const auto late = a_call();
  late->fail(std::make_exception_ptr(Disconnected("gone")));
  late->on_finished([&] { ++ran; });
  CHECK(ran == 2);
  CHECK_THROWS_AS(std::rethrow_exception(late->take_error()), Disconnected);
}

TEST_CASE("cancelling tells the transport once, and not after the end") {
  const auto call = a_call();
  int told = 0;
  call->set_canceller([&] { ++told; });
  call->cancel();
  call->cancel();
  CHECK(told == 1);
  CHECK_THROWS_AS(std::rethrow_exception(call->take_error()), Cancelled);

  const auto ended = a_call();
  ended->set_canceller([&] { ++told; });
  REQUIRE(ended->claim());
  ended->finish();
  ended->cancel();
  CHECK(told == 1);
  CHECK_FALSE(ended->take_error());
}

TEST_CASE("errors travel by number and come back as their own class") {
  CHECK_THROWS_AS(throw_error(ErrorCode::Unavailable, "x"), Unavailable);
  CHECK_THROWS_AS(throw_error(ErrorCode::Overloaded, "x"), Overloaded);
  CHECK_THROWS_AS(throw_error(ErrorCode::Disconnected, "x"), Disconnected);
  CHECK_THROWS_AS(throw_error(ErrorCode::TimedOut, "x"), TimedOut);
  CHECK_THROWS_AS(throw_error(ErrorCode::Cancelled, "x"), Cancelled);
  CHECK_THROWS_AS(throw_error(ErrorCode::Unimplemented, "x"), Unimplemented);
  CHECK_THROWS_AS(throw_error(ErrorCode::InvalidArgument, "x"), InvalidArgument);
  CHECK_THROWS_AS(throw_error(ErrorCode{4711}, "x"), Internal);
}

TEST_CASE("a thread that waits for a call takes its answer itself") {
  Asked asked;
  asked.incoming->bring = [&] { asked.answer(); };
  asked.call->wait();
  CHECK(asked.incoming->taken == 1);
  CHECK(asked.incoming->ended);
  CHECK(asked.incoming->attended == 0);
  CHECK(asked.incoming->calls == 0);
  asked.call->wait();
  CHECK(asked.incoming->taken == 1);
}

TEST_CASE("a thread that takes its answer itself is woken when the call ends otherwise") {
  Asked asked;
  std::atomic<bool> inside{false};
  asked.incoming->bring = [&] {
    inside = true;
    while (asked.incoming->woken == 0) std::this_thread::yield();
  };
  std::thread waiting([&] { asked.call->wait(); });
  while (!inside) std::this_thread::yield();
  asked.call->cancel();
  waiting.join();
  CHECK(asked.incoming->attended == 0);
}

TEST_CASE("where another thread takes the answers, who waits says so until the call ends") {
  Asked asked;
  std::thread waiting([&] { asked.call->wait(); });
  while (asked.incoming->attended == 0) std::this_thread::yield();
  asked.answer();
  waiting.join();
  CHECK(asked.incoming->taken == 1);
  CHECK(asked.incoming->attended == 0);
}

TEST_CASE("a call whose end is awaited without a thread is attended until then") {
  Asked asked;
  SECTION("by what is to run then") {
    asked.call->on_finished([] {});
  }
  SECTION("by looking now and then") {
    CHECK_FALSE(asked.call->finished());
    CHECK_FALSE(asked.call->finished());
  }
  CHECK(asked.incoming->attended == 1);
  asked.answer();
  CHECK(asked.incoming->attended == 0);
  CHECK(asked.call->finished());
  asked.call->on_finished([] {});
  CHECK(asked.incoming->attended == 0);
}

TEST_CASE("a call that is awaited before its connection is known is attended from then on") {
  const auto incoming = std::make_shared<Incoming>();
  const auto call = a_call();
  call->on_finished([] {});
  call->set_answers(incoming);
  CHECK(incoming->attended == 1);
  call->cancel();
  CHECK(incoming->attended == 0);

  const auto over = a_call();
  over->on_finished([] {});
  over->cancel();
  over->set_answers(incoming);
  CHECK(incoming->attended == 0);
  CHECK(incoming->calls == 0);
}
