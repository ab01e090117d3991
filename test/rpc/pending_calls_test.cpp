#include "rpc/client/pending_calls.hpp"

#include <catch2/catch.hpp>
#include <stdexcept>
#include <string_view>
#include <vector>

#include "test/connector/echo_service.hpp"

using namespace skein;
using namespace std::chrono_literals;
using rpc::PendingCalls;
using ::test::LouderEcho;

namespace {

const OperationInfo& operation_of(std::string_view name) {
  for (const OperationInfo& operation : LouderEcho::interface_info().operations) {
    if (operation.name == name) return operation;
  }
  throw std::runtime_error("no such operation");
}

/// A connection that may have three calls under way; time passes when the test says so.
struct Connection {
  PendingCalls::Call call(Duration left, std::string_view operation = "echo") {
    return std::make_shared<PendingCall>(operation_of(operation), nullptr, clock.after(left), true);
  }

  ManualClock clock;
  std::vector<std::uint64_t> due;
  const std::shared_ptr<PendingCalls> calls = std::make_shared<PendingCalls>(
      clock, 3, [this](std::uint64_t number) { due.push_back(number); });
};

using Numbers = std::vector<std::uint64_t>;

}  // namespace

TEST_CASE_METHOD(Connection, "calls are numbered from 1, and none is taken beyond their limit") {
  for (std::uint64_t i = 1; i <= 3; ++i) CHECK(calls->add(call(1s)) == i);
  CHECK(calls->add(call(1s)) == 0);
  CHECK(calls->remove(2).call != nullptr);
  CHECK(calls->add(call(1s)) == 4);
  CHECK(calls->size() == 3);
  CHECK(calls->total() == 4);
}

TEST_CASE_METHOD(Connection,
                 "each call is told to be due once its deadline is over, and no other") {
  calls->add(call(30ms));
  calls->add(call(10ms));
  calls->add(call(20ms));
  calls->remove(3);
  clock.advance(9ms);
  CHECK(due.empty());
  clock.advance(1ms);
  CHECK(due == Numbers{2});
  calls->remove(2);
  clock.advance(1s);
  CHECK(due == Numbers{2, 1});
}

TEST_CASE_METHOD(Connection, "who removes the last call is told so, and a stream can be kept") {
  calls->add(call(1s));
  calls->add(call(1s, "count_up"));
  CHECK_FALSE(calls->remove(1).last);
  const auto kept = calls->remove(2, PendingCalls::Keep::Streams);
  CHECK(kept.call != nullptr);
  CHECK_FALSE(kept.last);
  CHECK(calls->size() == 1);
  CHECK(calls->remove(2).last);
  CHECK(calls->remove(2).call == nullptr);
}

TEST_CASE_METHOD(Connection, "once closed it takes no call, and nothing is due any more") {
  calls->add(call(10ms));
  CHECK_FALSE(calls->close_if_empty());
  CHECK(calls->close().size() == 1);
  CHECK(calls->add(call(10ms)) == std::nullopt);
  CHECK(calls->close_if_empty());
  clock.advance(1s);
  CHECK(due.empty());
}
