#include "rpc/service/call_journal.hpp"

#include <algorithm>
#include <catch2/catch.hpp>

#include "echo_pair.hpp"
#include "entity/entity_access.hpp"
#include "pairing.hpp"
#include "skein/detail/codec.hpp"
#include "skein/introspection.idl.hpp"
#include "test/tools/eventually.hpp"
#include "test/tools/log.hpp"

using namespace skein;
using namespace skein::test;
using namespace std::chrono_literals;
using introspection::CallEvent;
using introspection::CallEvents;
using introspection::CallStep;
using ::test::Echo;
using ::test::LouderEcho;
using Steps = std::vector<CallStep>;

namespace {

class Heard {
 public:
  explicit Heard(dds::Participant& participant)
      : reader_(participant, introspection::kTopic<CallEvents>, [this](const CallEvents& batch) {
          std::lock_guard lock(mutex_);
          events_.insert(events_.end(), batch.values.begin(), batch.values.end());
          dropped_ = std::max(dropped_, batch.dropped);
        }) {}

  /// The steps of the last call of that operation, in the order of time.
  Steps last(const std::string& operation) const {
    std::vector<CallEvent> call;
    std::lock_guard lock(mutex_);
    std::uint64_t number = 0;
    for (const CallEvent& event : events_) {
      if (event.operation == operation) number = std::max(number, event.number);
    }
    for (const CallEvent& event : events_) {
      if (event.operation == operation && event.number == number) call.push_back(event);
    }
    std::ranges::stable_sort(call, {}, &CallEvent::time);
    Steps steps;
    for (const CallEvent& event : call) steps.push_back(event.step);
    return steps;
  }

  std::uint64_t refused() const { return reader_.refused(); }

  std::uint64_t dropped() const {
    std::lock_guard lock(mutex_);
    return dropped_;
  }

  std::vector<CallEvent> all() const {
    std::lock_guard lock(mutex_);
    return events_;
  }

 private:
  mutable std::mutex mutex_;
  std::vector<CallEvent> events_;
  std::uint64_t dropped_ = 0;
  introspection::Reader<CallEvents> reader_;  // last: goes first
};

const Steps kWhole{CallStep::Sent, CallStep::Received, CallStep::Replied, CallStep::Answered};
const Steps kRefused{CallStep::Sent, CallStep::Received, CallStep::RepliedError,
                     CallStep::EndedInError};

/// Calls until each step of a call is heard. Best effort: the first ones may come before the
/// journals know of the reader.
bool hears(const Heard& heard, Echo::Proxy& echo) {
  return eventually([&] {
    echo.echo("x");
    return eventually([&] { return heard.last("echo") == kWhole; }, 100ms);
  });
}

}  // namespace

TEST_CASE("while somebody reads, each step of a call is told by both sides under one number",
          "[wire]") {
  EchoPair pair(make_server(), make_client());
  auto& echo = *pair.echo;
  const Heard heard(EntityAccess::participant(*pair.client));
  REQUIRE(hears(heard, echo));
  std::int32_t remainder;
  CHECK_THROWS_AS(echo.divide(1, 0, remainder), ::test::DivisionByZero);
  CHECK(eventually([&] { return heard.last("divide") == kWhole; }));
  CHECK_THROWS_AS(echo.fail("standard"), Internal);
  CHECK(eventually([&] { return heard.last("fail") == kRefused; }));

  echo.note("a oneway call");
  CHECK(eventually([&] { return heard.last("note").size() == 4; }));

  CHECK_THROWS_AS(echo.within(50ms).wait(20'000), TimedOut);
  const Steps late{CallStep::Sent, CallStep::Received, CallStep::EndedInError,
                   CallStep::RepliedError};
  CHECK(eventually([&] { return std::ranges::is_permutation(heard.last("wait"), late); }));
  for (const CallEvent& event : heard.all()) {
    const bool at_client = event.step == CallStep::Sent || event.step == CallStep::Answered ||
                           event.step == CallStep::EndedInError;
    CHECK(event.entity == (at_client ? "uav-1/client" : "uav-1/server"));
    CHECK(event.service == "test::LouderEcho");
    CHECK(event.client == heard.all().front().client);
  }
  CHECK(heard.dropped() == 0);
}

TEST_CASE("a call within a process is told by both sides, too") {
  const auto entity = make_server();
  const auto thread = GENERATE(CallThread::Own, CallThread::Caller);
  entity->provide<LouderEcho>(std::make_shared<EchoService>(), {.thread = thread});
  auto echo = entity->connect<Echo>();
  const auto onlooker = make_client();
  const Heard heard(EntityAccess::participant(*onlooker));
  REQUIRE(hears(heard, echo));
  CHECK_THROWS_AS(echo.fail("standard"), Internal);
  CHECK(eventually([&] { return heard.last("fail") == kRefused; }));
  echo.async_echo("y").get();
  CHECK(eventually([&] { return heard.last("echo") == kWhole; }));
  echo.note("a oneway call");
  CHECK(eventually([&] { return heard.last("note").size() == 4; }));
  auto waiting = echo.async_wait(20'000);
  waiting.cancel();
  // The service may have begun, and returns then.
  CHECK(eventually([&] { return heard.last("wait").size() == 4; }));
  CHECK(std::ranges::count(heard.last("wait"), CallStep::EndedInError) == 1);
}

TEST_CASE("a journal is on while it is read") {
  const auto entity = make_server();
  const auto other = make_client();
  ManualClock clock;
  ManualExecutor control;
  rpc::CallJournal journal(EntityAccess::participant(*entity), clock, control, "uav-1/test");
  const OperationInfo& operation = Echo::interface_info().operations[0];
  const auto note = [&] { journal.note(CallStep::Sent, Guid{}, 1, "test/Echo", operation); };
  CHECK_FALSE(journal.on());
  note();
  CHECK(control.run_all() == 0);
  {
    const Heard heard(EntityAccess::participant(*other));
    REQUIRE(eventually([&] { return journal.on(); }));
    CHECK(eventually([&] {  // best effort
      note();
      clock.advance(1s);
      control.run_all();
      return !heard.all().empty();
    }));
  }
  CHECK(eventually([&] { return !journal.on(); }));
  journal.close();
}

TEST_CASE("malformed events are counted, and the first alone is logged") {
  const auto entity = make_server();
  const auto other = make_client();
  const Heard heard(EntityAccess::participant(*other));
  const Log log;
  dds::Qos qos;
  qos.reliable = false;
  const auto writer = EntityAccess::participant(*entity).create_writer(
      {"skein/calls", "skein::introspection::CallEvents", false}, qos);
  Bytes malformed = idl::encode_message(CallEvents{});
  malformed.resize(malformed.size() / 2);
  // Best effort: the first ones may come before the reader is known.
  CHECK(eventually([&] {
    writer->write(malformed);
    return heard.refused() >= 10;
  }));
  CHECK(log.count("dropped a sample of participant " +
                  EntityAccess::participant(*entity).guid().hex().substr(0, 24)) == 1);
  CHECK(heard.all().empty());
}
