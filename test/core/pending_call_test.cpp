#include <atomic>
#include <catch2/catch.hpp>
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
