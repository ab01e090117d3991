#include <catch2/catch.hpp>
#include <future>

#include "../tools/eventually.hpp"
#include "../tools/invariant.hpp"
#include "echo_service.hpp"
#include "pairing.hpp"

using namespace skein;
using namespace skein::test;
using namespace std::chrono_literals;
using ::test::Echo;
using ::test::LouderEcho;

namespace {

constexpr std::int32_t kNever = -1;
constexpr std::int32_t kEndlessStream = 1 << 30;
constexpr std::int32_t kWindow = PendingStream::kWindow;

// A service and a client of it: in another entity, or in the service's own and so in one process.
struct Streaming {
  explicit Streaming(bool same_process)
      : server(make_server()), service(std::make_shared<EchoService>()) {
    ServiceOptions options;
    options.threads = 2;
    id = server->provide<LouderEcho>(service, options);
    if (!same_process) client = make_client();
  }

  Echo::Proxy connect() { return (client ? *client : *server).connect<Echo>(); }

  std::unique_ptr<Entity> server;
  std::shared_ptr<EchoService> service;
  std::unique_ptr<Entity> client;
  Guid id;
};

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

TEST_CASE("a stream brings every result in order and then ends", "[wire]") {
  Streaming test(GENERATE(false, true));
  auto echo = test.connect();
  std::int32_t expected = 0;
  for (const std::int32_t number : echo.count_up(1000, kNever)) INVARIANT(number == expected++);
  INVARIANT(expected == 1000);
  auto empty = echo.count_up(0, kNever);
  CHECK(empty.next() == std::nullopt);
  CHECK(empty.next() == std::nullopt);
  CHECK(eventually([&] { return test.service->inside == 0; }));
}

TEST_CASE("results that came before a stream failed are taken before the failure is thrown") {
  Streaming test(GENERATE(false, true));
  auto echo = test.connect();
  auto numbers = echo.count_up(10, 3);
  for (std::int32_t i = 0; i < 3; ++i) CHECK(numbers.next() == i);
  CHECK_THROWS_AS(numbers.next(), ::test::DivisionByZero);
  CHECK(numbers.next() == std::nullopt);
}

TEST_CASE("a reader that takes nothing holds the server up, and nothing piles up", "[wire]") {
  Streaming test(GENERATE(false, true));
  auto echo = test.connect();
  auto numbers = echo.within(10min).count_up(100, kNever);
  REQUIRE(eventually([&] { return test.service->pushed == kWindow; }));
  CHECK(echo.echo("an answer, which comes later than any result that was not waited with") != "");
  CHECK(test.service->pushed == kWindow);
  for (std::int32_t i = 0; i < 100; ++i) {
    REQUIRE(numbers.next() == i);
    REQUIRE(test.service->pushed <= i + 1 + kWindow);
  }
  CHECK(numbers.next() == std::nullopt);
}

TEST_CASE("a service that does not want to wait is told that its reader is behind") {
  Streaming test(GENERATE(false, true));
  auto echo = test.connect();
  auto stream = echo.within(10min).burst(100'000);
  REQUIRE(eventually([&] { return test.service->stream_ended.load(); }));
  int blocks = 0;
  for (const auto& block : stream) {
    CHECK(block.size() == 100'000);
    ++blocks;
  }
  CHECK(blocks == kWindow);
  CHECK(blocks == test.service->pushed);
}

TEST_CASE("a reader that drops or cancels its stream stops the server", "[wire]") {
  Streaming test(GENERATE(false, true));
  const bool drop = GENERATE(true, false);
  auto echo = test.connect();
  {
    auto numbers = echo.within(10min).count_up(kEndlessStream, kNever);
    CHECK(numbers.next() == 0);
    if (!drop) {
      numbers.cancel();
      CHECK_THROWS_AS(numbers.next(), Cancelled);
    }
  }
  CHECK(eventually([&] { return test.service->stream_ended.load(); }));
  CHECK(test.service->saw_cancellation);
}

TEST_CASE("a stream that gives way to another is dropped at once") {
  Streaming test(GENERATE(false, true));
  auto echo = test.connect();
  auto numbers = echo.within(10min).count_up(kEndlessStream, kNever);
  CHECK(numbers.next() == 0);
  CHECK(numbers.next() == 1);
  auto others = echo.within(10min).count_up(3, kNever);
  numbers = std::move(others);
  CHECK(eventually([&] { return test.service->saw_cancellation.load(); }));
  CHECK(numbers.next() == 0);
}

TEST_CASE("the deadline ends a stream at both ends") {
  Streaming test(GENERATE(false, true));
  auto echo = test.connect();
  std::optional<Stream<std::int32_t>> numbers;
  REQUIRE(with_enough_time(300ms, [&](auto limit) {
    numbers.emplace(echo.within(limit).count_up(kEndlessStream, kNever));
    return eventually([&] { return test.service->stream_ended.load(); }, 2 * limit);
  }));
  std::int32_t taken = 0;
  CHECK_THROWS_AS(
      [&] {
        while (numbers->next()) ++taken;
      }(),
      TimedOut);
  CHECK(taken <= kWindow);
}

TEST_CASE("a stream whose provider leaves ends as Disconnected, and holds up nobody's leaving",
          "[wire]") {
  Streaming test(GENERATE(false, true));
  auto echo = test.connect();
  auto numbers = echo.within(10min).count_up(kEndlessStream, kNever);
  CHECK(numbers.next() == 0);
  test.server->withdraw(test.id);
  CHECK_THROWS_AS(
      [&] {
        while (numbers.next()) {
        }
      }(),
      Disconnected);
  CHECK(test.service->stream_ended);
}

TEST_CASE("a stream whose reader disconnects stops the server", "[wire]") {
  Streaming test(GENERATE(false, true));
  auto echo = test.connect();
  auto numbers = echo.within(10min).count_up(kEndlessStream, kNever);
  CHECK(numbers.next() == 0);
  echo.disconnect();
  CHECK(eventually([&] { return test.service->stream_ended.load(); }));
  CHECK_THROWS_AS(
      [&] {
        while (numbers.next()) {
        }
      }(),
      Cancelled);
}

TEST_CASE("a coroutine takes a stream without a thread that waits") {
  Streaming test(GENERATE(false, true));
  auto echo = test.connect();
  std::promise<std::int64_t> sum;
  sum_up(echo.count_up(100, kNever), sum);
  CHECK(sum.get_future().get() == 4950);
  std::promise<std::int64_t> failed;
  sum_up(echo.count_up(100, 50), failed);
  CHECK_THROWS_AS(failed.get_future().get(), ::test::DivisionByZero);
}

TEST_CASE("streams of one client do not disturb each other", "[wire]") {
  Streaming test(GENERATE(false, true));
  auto echo = test.connect();
  auto one = echo.count_up(100, kNever);
  auto other = echo.count_up(100, kNever);
  for (std::int32_t i = 0; i < 100; ++i) {
    REQUIRE(one.next() == i);
    REQUIRE(other.next() == i);
  }
}

TEST_CASE("a proxy is an implementation too: it passes a stream on to a sink") {
  struct Collected final : StreamSink<std::int32_t> {
    bool put(std::int32_t item, bool) override {
      items.push_back(item);
      return true;
    }
    std::vector<std::int32_t> items;
  };
  Streaming test(GENERATE(false, true));
  auto echo = test.connect();
  Collected collected;
  Echo& implementation = echo;
  implementation.count_up(20, kNever, collected);
  CHECK(collected.items.size() == 20);
}
