#include "rpc/service/outgoing_stream.hpp"

#include <atomic>
#include <catch2/catch.hpp>
#include <thread>
#include <vector>

#include "echo.idl.hpp"

using namespace skein;
using namespace skein::rpc;
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
  explicit Numbers(std::uint32_t credit)
      : stream(std::make_shared<OutgoingStream>(
            count_up(), clock, clock.now() + 1s, credit,
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
