#include "rpc/service/outgoing_stream.hpp"

#include <atomic>
#include <catch2/catch.hpp>
#include <future>
#include <thread>
#include <vector>

#include "echo.idl.hpp"
#include "test/tools/eventually.hpp"

using namespace skein;
using namespace skein::rpc;
using skein::test::eventually;
using ::test::Echo_count_up_Out;
using namespace std::chrono_literals;

namespace {

const OperationInfo& count_up() {
  for (const OperationInfo& operation : ::test::Echo::interface_info().operations) {
    if (operation.stream) return operation;
  }
  throw std::logic_error("the interface has no stream");
}

// A stream of numbers whose results stay here.
struct Numbers {
  explicit Numbers(std::uint32_t credit, Duration limit = 1s)
      : stream(std::make_shared<OutgoingStream>(
            count_up(), clock, clock.now() + limit, credit,
            [this](const void* out, std::uint64_t position) {
              REQUIRE(position == sent.size());
              sent.push_back(static_cast<const Echo_count_up_Out*>(out)->return_);
            })) {}

  bool put(int number, bool wait = false) {
    const Echo_count_up_Out out{number};
    return stream->put(&out, wait);
  }

  // Puts on a thread of its own; what it throws ends there.
  std::thread put_waiting(int number, std::atomic<int>& ended) {
    return std::thread([this, number, &ended] {
      try {
        put(number, true);
        ended = 1;
      } catch (const TimedOut&) {
        ended = 2;
      } catch (const Cancelled&) {
        ended = 3;
      }
    });
  }

  ManualClock clock;
  std::vector<int> sent;
  std::shared_ptr<OutgoingStream> stream;
};

}  // namespace

TEST_CASE("no more results are sent than were granted") {
  Numbers numbers(2);
  CHECK(numbers.put(1));
  CHECK(numbers.put(2));
  CHECK_FALSE(numbers.put(3));
  numbers.stream->grant(1);
  CHECK(numbers.put(4));
  CHECK_FALSE(numbers.put(5));
  CHECK(numbers.sent == std::vector<int>{1, 2, 4});
  CHECK(numbers.stream->finish() == nullptr);
}

TEST_CASE("a grant beyond all bounds stays within them") {
  Numbers numbers(0xFFFFFFFF);
  numbers.stream->grant(0xFFFFFFFF);
  CHECK(numbers.put(1));
  CHECK(numbers.put(2));
}

TEST_CASE("no caller is sent more than a window of results ahead, whatever it grants") {
  Numbers numbers(65'535);
  numbers.stream->grant(65'535);
  for (std::uint32_t i = 0; i < PendingStream::kWindow; ++i) CHECK(numbers.put(1));
  CHECK_FALSE(numbers.put(1));
}

TEST_CASE("what waits for credit goes on with it, and ends with the deadline or with the caller") {
  Numbers numbers(1);
  std::atomic<int> ended = 0;
  numbers.put(1);
  std::thread waiting = numbers.put_waiting(2, ended);
  int expected = 0;
  SECTION("credit") {
    numbers.stream->grant(1);
    expected = 1;
  }
  SECTION("deadline") {
    numbers.clock.advance(1s);
    expected = 2;
  }
  SECTION("caller") {
    numbers.stream->stop(ErrorCode::Cancelled, "its caller has gone");
    expected = 3;
  }
  waiting.join();
  CHECK(ended == expected);
}

namespace {

/// Puts on a thread of its own; the text of what it throws, or nothing.
std::future<std::string> put_apart(Numbers& numbers, int number) {
  return std::async(std::launch::async, [&numbers, number]() -> std::string {
    try {
      numbers.put(number, true);
      return "";
    } catch (const Overloaded& error) {
      return error.what();
    }
  });
}

}  // namespace

TEST_CASE("a caller that takes nothing while other calls wait for the thread loses its stream") {
  Numbers numbers(1, 10min);
  std::atomic<bool> others = true;
  numbers.stream->set_others_wait([&] { return others.load(); });
  numbers.put(1);
  auto waiting = put_apart(numbers, 2);
  SECTION("if nobody waits, not before its deadline") {
    others = false;
    for (int minute = 0; minute < 9; ++minute) numbers.clock.advance(1min);
    CHECK(waiting.wait_for(0s) == std::future_status::timeout);
    numbers.stream->grant(1);
    CHECK(waiting.get().empty());
  }
  SECTION("if it takes results slowly, never") {
    for (int i = 2; i < 100; ++i) {
      numbers.clock.advance(OutgoingStream::kPatience - 1ms);
      numbers.stream->grant(1);
      REQUIRE(waiting.get().empty());
      waiting = put_apart(numbers, i + 1);
    }
    numbers.stream->stop(ErrorCode::Overloaded, "the test ends");
  }
  SECTION("otherwise in seconds, and it is told why") {
    CHECK(eventually([&] {
      numbers.clock.advance(1s);
      return waiting.wait_for(1ms) == std::future_status::ready;
    }));
    CHECK_THAT(waiting.get(), Catch::Contains("its caller took no result for ") &&
                                  Catch::Contains("other calls waited"));
    CHECK_THROWS_AS(numbers.put(3, true), Overloaded);
    CHECK_THROWS_AS(numbers.put(3, false), Overloaded);
  }
}

TEST_CASE("a reader that takes few results grants each, one that takes many some at a time") {
  PendingStream stream(count_up(), Instant::max());
  std::vector<std::uint32_t> granted;
  stream.set_granter([&](std::uint32_t count) { granted.push_back(count); });
  const auto deliver = [&] {
    return stream.deliver({count_up().out->make(), count_up().out->destroy});
  };
  for (std::uint32_t i = 0; i < PendingStream::kWindow; ++i) REQUIRE(deliver());
  REQUIRE(stream.next());
  CHECK(granted == std::vector<std::uint32_t>{1});  // the provider had to wait
  for (std::uint32_t i = 0; i < PendingStream::kWindow / 2; ++i) REQUIRE(stream.next());
  CHECK(granted == std::vector<std::uint32_t>{1, PendingStream::kWindow / 2});
}

TEST_CASE("a result that cannot be sent takes the room of no other") {
  ManualClock clock;
  int sent = 0;
  const auto stream = std::make_shared<OutgoingStream>(
      count_up(), clock, clock.now() + 1s, 1, [&](const void* out, std::uint64_t) {
        if (static_cast<const Echo_count_up_Out*>(out)->return_ < 0) throw Internal("not this one");
        ++sent;
      });
  const Echo_count_up_Out bad{-1};
  const Echo_count_up_Out good{1};
  CHECK_THROWS_AS(stream->put(&bad, false), Internal);
  CHECK(stream->put(&good, false));
  CHECK_FALSE(stream->put(&good, false));
  CHECK(sent == 1);
}

TEST_CASE("a caller that grants nothing gets the last result, and cannot get none") {
  Numbers numbers(0);
  CHECK_THROWS_AS(numbers.stream->finish(), Internal);
  CHECK(numbers.put(1));
  CHECK(numbers.put(2, true));
  CHECK(numbers.sent.empty());
  CHECK(static_cast<const Echo_count_up_Out*>(numbers.stream->finish())->return_ == 2);
}
