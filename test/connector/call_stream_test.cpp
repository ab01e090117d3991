#include <catch2/catch.hpp>
#include <future>

#include "echo_service.hpp"
#include "pairing.hpp"
#include "test/tools/eventually.hpp"
#include "test/tools/invariant.hpp"

using namespace skein;
using namespace skein::test;
using namespace std::chrono_literals;
using ::test::Echo;
using ::test::LouderEcho;

namespace {

constexpr std::int32_t kNever = -1;
constexpr std::int32_t kEndlessStream = 1 << 30;
constexpr std::int32_t kWindow = PendingStream::kWindow;

/// A service and a client of it: in another entity, or in the service's own and so in one process.
struct Streaming {
  const std::shared_ptr<EchoService> service = std::make_shared<EchoService>();
  const std::unique_ptr<Entity> server = make_server();
  const Guid id = server->provide<LouderEcho>(service, {.threads = 2});
  const std::unique_ptr<Entity> client = GENERATE(false, true) ? make_client() : nullptr;
  Echo::Proxy echo = (client ? *client : *server).connect<Echo>();
};

/// Takes all that comes.
template <class T>
std::int32_t exhaust(Stream<T>& stream) {
  std::int32_t taken = 0;
  while (stream.next()) ++taken;
  return taken;
}

struct Detached {
  struct promise_type {
    Detached get_return_object() { return {}; }
    std::suspend_never initial_suspend() { return {}; }
    std::suspend_never final_suspend() noexcept { return {}; }
    void return_void() {}
    void unhandled_exception() { std::terminate(); }
  };
};

Detached sum_up(Stream<std::int32_t> numbers, std::promise<std::int64_t>& sum) {
  try {
    std::int64_t total = 0;
    while (const auto number = co_await numbers.next_async()) total += *number;
    sum.set_value(total);
  } catch (...) {
    sum.set_exception(std::current_exception());
  }
}

}  // namespace

TEST_CASE_METHOD(Streaming, "a stream brings every result in order and then ends", "[wire]") {
  std::int32_t expected = 0;
  for (const std::int32_t number : echo.count_up(1000, kNever)) INVARIANT(number == expected++);
  INVARIANT(expected == 1000);
  auto empty = echo.count_up(0, kNever);
  CHECK(empty.next() == std::nullopt);
  CHECK(empty.next() == std::nullopt);
  CHECK(eventually([&] { return service->inside == 0; }));
}

TEST_CASE_METHOD(
    Streaming, "results that came before a stream failed are taken before the failure is thrown") {
  auto numbers = echo.count_up(10, 3);
  for (std::int32_t i = 0; i < 3; ++i) CHECK(numbers.next() == i);
  CHECK_THROWS_AS(numbers.next(), ::test::DivisionByZero);
  CHECK(numbers.next() == std::nullopt);
}

TEST_CASE_METHOD(Streaming, "a reader that takes nothing holds the server up, and nothing piles up",
                 "[wire]") {
  auto numbers = echo.within(10min).count_up(100, kNever);
  REQUIRE(eventually([&] { return service->pushed == kWindow; }));
  CHECK(echo.echo("an answer, which comes later than any result that was not waited with") != "");
  CHECK(service->pushed == kWindow);
  for (std::int32_t i = 0; i < 100; ++i) {
    REQUIRE(numbers.next() == i);
    REQUIRE(service->pushed <= i + 1 + kWindow);
  }
  CHECK(numbers.next() == std::nullopt);
}

TEST_CASE_METHOD(Streaming,
                 "a service that does not want to wait is told that its reader is behind") {
  auto stream = echo.within(10min).burst(100'000);
  REQUIRE(eventually([&] { return service->stream_ended.load(); }));
  int blocks = 0;
  for (const auto& block : stream) {
    CHECK(block.size() == 100'000);
    ++blocks;
  }
  CHECK(blocks == kWindow);
  CHECK(blocks == service->pushed);
}

TEST_CASE_METHOD(Streaming, "a reader that drops or cancels its stream stops the server",
                 "[wire]") {
  const bool drop = GENERATE(true, false);
  {
    auto numbers = echo.within(10min).count_up(kEndlessStream, kNever);
    CHECK(numbers.next() == 0);
    if (!drop) {
      numbers.cancel();
      CHECK_THROWS_AS(numbers.next(), Cancelled);
    }
  }
  CHECK(eventually([&] { return service->stream_ended.load(); }));
  CHECK(service->saw_cancellation);
}

TEST_CASE_METHOD(Streaming, "a stream that gives way to another is dropped at once") {
  auto numbers = echo.within(10min).count_up(kEndlessStream, kNever);
  CHECK(numbers.next() == 0);
  CHECK(numbers.next() == 1);
  auto others = echo.within(10min).count_up(3, kNever);
  numbers = std::move(others);
  CHECK(eventually([&] { return service->saw_cancellation.load(); }));
  CHECK(numbers.next() == 0);
}

TEST_CASE_METHOD(Streaming, "the deadline ends a stream at both ends") {
  std::optional<Stream<std::int32_t>> numbers;
  REQUIRE(with_enough_time(300ms, [&](auto limit) {
    numbers.emplace(echo.within(limit).count_up(kEndlessStream, kNever));
    return eventually([&] { return service->stream_ended.load(); }, 2 * limit);
  }));
  std::int32_t taken = 0;
  CHECK_THROWS_AS(
      [&] {
        while (numbers->next()) ++taken;
      }(),
      TimedOut);
  CHECK(taken <= kWindow);
}

TEST_CASE_METHOD(
    Streaming, "a stream whose provider leaves ends as Disconnected, and holds up nobody's leaving",
    "[wire]") {
  auto numbers = echo.within(10min).count_up(kEndlessStream, kNever);
  CHECK(numbers.next() == 0);
  server->withdraw(id);
  CHECK_THROWS_AS(exhaust(numbers), Disconnected);
  CHECK(service->stream_ended);
}

TEST_CASE_METHOD(Streaming, "a stream whose reader disconnects stops the server", "[wire]") {
  auto numbers = echo.within(10min).count_up(kEndlessStream, kNever);
  CHECK(numbers.next() == 0);
  echo.disconnect();
  CHECK(eventually([&] { return service->stream_ended.load(); }));
  CHECK_THROWS_AS(exhaust(numbers), Cancelled);
}

TEST_CASE_METHOD(Streaming, "a coroutine takes a stream without a thread that waits") {
  std::promise<std::int64_t> sum;
  sum_up(echo.count_up(100, kNever), sum);
  CHECK(sum.get_future().get() == 4950);
  std::promise<std::int64_t> failed;
  sum_up(echo.count_up(100, 50), failed);
  CHECK_THROWS_AS(failed.get_future().get(), ::test::DivisionByZero);
}

TEST_CASE_METHOD(Streaming, "streams of one client do not disturb each other", "[wire]") {
  auto one = echo.count_up(100, kNever);
  auto other = echo.count_up(100, kNever);
  for (std::int32_t i = 0; i < 100; ++i) {
    REQUIRE(one.next() == i);
    REQUIRE(other.next() == i);
  }
}

TEST_CASE_METHOD(Streaming, "a proxy is an implementation too: it passes a stream on to a sink") {
  struct Collected final : StreamSink<std::int32_t> {
    bool put(std::int32_t item, bool) override {
      items.push_back(item);
      return true;
    }
    std::vector<std::int32_t> items;
  };
  Collected collected;
  Echo& implementation = echo;
  implementation.count_up(20, kNever, collected);
  CHECK(collected.items.size() == 20);
}
