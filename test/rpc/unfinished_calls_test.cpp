#include "rpc/service/unfinished_calls.hpp"

#include <catch2/catch.hpp>
#include <chrono>
#include <memory>
#include <optional>

#include "rpc/service/call_intake.hpp"
#include "rpc/service/owed_answers.hpp"
#include "skein/error.hpp"

using namespace skein;
using namespace std::chrono_literals;

namespace {

/// Only owed, never answered.
struct Reply final : PendingReply {
  void* out() noexcept override { return nullptr; }
  bool claim() override { return false; }
  void finish(std::exception_ptr) override {}
  const CallContext& call() const noexcept override { return context; }
  void on_cancel(Action) override {}

  ManualClock clock;
  const CallContext context{clock, Instant::max(), Guid(), {}, nullptr, nullptr};
};

std::shared_ptr<rpc::Invocation> call_of_anyone() { return std::make_shared<rpc::Invocation>(); }

struct Desk {
  bool finish() { return calls.finish(clock, clock.now(), owed); }

  ManualClock clock;
  const std::shared_ptr<std::atomic<bool>> leaving = std::make_shared<std::atomic<bool>>(true);
  rpc::UnfinishedCalls calls{leaving};
  rpc::OwedAnswers owed{4};
  rpc::CallIntake intake{"Desk", 4, calls, owed};
};

}  // namespace

TEST_CASE_METHOD(Desk, "a service finishes once no call waits, runs or is owed an answer") {
  rpc::Invocation invocation;
  const auto reply = std::make_shared<Reply>();
  intake.add(call_of_anyone(), false);
  CHECK_FALSE(finish());
  REQUIRE(intake.take());
  {
    const rpc::UnfinishedCalls::Running running(calls, invocation);
    calls.note_done();
    CHECK(calls.none_accepted());
    CHECK_FALSE(finish());
    owed.add(*reply, {});
  }
  CHECK_FALSE(finish());
  calls.accept();
  owed.remove(*reply, {});
  CHECK_FALSE(finish());
  calls.note_done();
  CHECK_FALSE(calls.closed());
  CHECK(finish());
  CHECK(calls.closed());
}

TEST_CASE_METHOD(Desk, "once closed none waits, none runs and none is owed an answer") {
  const bool finished = GENERATE(true, false);
  if (finished) {
    REQUIRE(finish());
  } else {
    calls.close("Desk was withdrawn");
    CHECK(owed.close().empty());
    CHECK_FALSE(owed.add(*std::make_shared<Reply>(), {}));
  }
  CHECK_THROWS_AS(intake.add(call_of_anyone(), false), NotSent);
  CHECK(calls.none_accepted());
  rpc::Invocation invocation;
  CHECK_FALSE(rpc::UnfinishedCalls::Running(calls, invocation).admitted());
}

TEST_CASE_METHOD(Desk, "a full queue, and as many owed answers as it may have, refuse calls") {
  const auto replies = {std::make_shared<Reply>(), std::make_shared<Reply>()};
  for (const auto& reply : replies) REQUIRE(owed.add(*reply, {}));
  CHECK_THROWS_WITH(intake.add(call_of_anyone(), true), Catch::Contains("owes as many answers"));
  CHECK_NOTHROW(intake.add(call_of_anyone(), false));
  CHECK_NOTHROW(intake.add(call_of_anyone(), false));
  CHECK_THROWS_WITH(intake.add(call_of_anyone(), true), Catch::Contains("queue of Desk is full"));
  CHECK(intake.size() == 2);
  CHECK(owed.close().size() == 2);
}

TEST_CASE_METHOD(Desk, "close() tells those inside, and await_end() sees them go") {
  rpc::Invocation invocation;
  std::optional<rpc::UnfinishedCalls::Running> running;
  running.emplace(calls, invocation);
  calls.close("Desk was withdrawn");
  CHECK(invocation.cancelled);
  CHECK_FALSE(calls.await_end({}));
  running.reset();
  CHECK(calls.await_end({}));
}

// close() stops streams under the lock of UnfinishedCalls, and a stream without credit asks under
// its own whether others wait. So the intake may take neither while it holds its own.
TEST_CASE_METHOD(Desk, "calls are queued and taken while UnfinishedCalls holds its lock") {
  rpc::Invocation inside;
  const rpc::UnfinishedCalls::Running running(calls, inside);
  std::size_t waiting = 0;
  calls.count([&](const rpc::Invocation&) {
    intake.add(call_of_anyone(), true);
    waiting = intake.size();
    return intake.take() != nullptr;
  });
  CHECK(waiting == 1);
}
