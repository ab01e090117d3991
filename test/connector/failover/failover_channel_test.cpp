#include "connector/failover_channel.hpp"

#include <catch2/catch.hpp>

#include "fake_provider.hpp"
#include "test/brokerless_discovery/descriptions.hpp"

using namespace skein;
using namespace skein::connector;
using namespace skein::test;
using namespace std::chrono_literals;

namespace {

struct NumberCall final : PendingCall {
  NumberCall(const OperationInfo& operation, Instant deadline)
      : PendingCall(operation, &value, deadline, false) {}
  int value = 0;
};

/// Providers 1, 2, ... that are connected to in this order, with invented time.
struct World {
  explicit World(int count, std::optional<Duration> hedge_after = std::nullopt) {
    for (int i = 0; i < count; ++i)
      providers.push_back(std::make_shared<FakeChannel>(clock, continuations));
    channel = std::make_shared<FailoverChannel>(
        link_to(1), [this](const ProviderQuery& wanted) { return connect(wanted); }, hedge_after);
  }

  ProviderConnection link_to(int number) {
    return {guid(static_cast<std::uint8_t>(number)),
            providers[static_cast<std::size_t>(number - 1)], provider(number).suspect};
  }

  ProviderConnection connect(const ProviderQuery& wanted) {
    const auto found = [](const std::vector<Guid>& list, const Guid& id) {
      return std::find(list.begin(), list.end(), id) != list.end();
    };
    for (const bool last : {false, true}) {
      for (std::size_t i = 0; i < providers.size(); ++i) {
        const Guid id = guid(static_cast<std::uint8_t>(i + 1));
        if (found(wanted.excluded, id) || found(wanted.last, id) != last || !providers[i]->stands)
          continue;
        if (*providers[i]->suspect) continue;
        return link_to(static_cast<int>(i + 1));
      }
    }
    if (refusal == ErrorCode::Unavailable) throw NoProvider("nobody is left");
    throw_error(refusal, "nobody is left");
  }

  /// The provider is there again, by a connection of its own.
  void restart(int number) {
    gone.push_back(std::exchange(providers[static_cast<std::size_t>(number - 1)],
                                 std::make_shared<FakeChannel>(clock, continuations)));
    channel->changes().on_change();
    continuations.run_all();
  }

  std::shared_ptr<NumberCall> call(const OperationInfo& operation) {
    auto call = std::make_shared<NumberCall>(operation, clock.now() + 10s);
    int in = 7;
    channel->start(call, &in);
    in = 0;
    return call;
  }

  FakeChannel& provider(int number) { return *providers[static_cast<std::size_t>(number - 1)]; }

  ManualClock clock;
  ManualExecutor continuations;
  std::vector<std::shared_ptr<FakeChannel>> providers;
  std::vector<std::shared_ptr<FakeChannel>> gone;
  std::shared_ptr<FailoverChannel> channel;
  ErrorCode refusal = ErrorCode::Unavailable;  // where there is nobody
};

const OperationInfo kIdempotent = number_operation(true);
const OperationInfo kOther = number_operation(false);

}  // namespace

TEST_CASE(
    "an idempotent call moves with its arguments, and the thread that told of the failure connects "
    "to nobody") {
  World world(2);
  const auto call = world.call(kIdempotent);
  world.provider(1).lose();
  CHECK(world.provider(2).calls.empty());
  CHECK_FALSE(call->finished());
  world.continuations.run_all();
  REQUIRE(world.provider(2).calls.size() == 1);
  CHECK(world.provider(2).arguments[0] == 7);
  world.provider(2).answer(0, 5);
  CHECK(call->finished());
  CHECK(call->take_error() == nullptr);
  CHECK(call->value == 5);
}

TEST_CASE("hedges add no more than the budget to a connection's calls") {
  World world(2, 10ms);
  for (int i = 0; i < 160; ++i) {
    const auto call = world.call(kIdempotent);
    world.clock.advance(10ms);
    world.continuations.run_all();
    world.provider(1).answer(static_cast<std::size_t>(i), 5);
    CHECK(call->value == 5);
  }
  CHECK(world.provider(1).calls.size() == 160);
  CHECK(world.provider(2).calls.size() == 14);  // 5 from the start, then one for 16 calls
}

TEST_CASE("calls that all providers refuse are repeated no more than the budget allows") {
  World world(2);
  world.provider(1).refuses = world.provider(2).refuses = true;
  for (int i = 0; i < 160; ++i) {
    const auto call = world.call(kIdempotent);
    world.continuations.run_all();
    CHECK_THROWS_AS(std::rethrow_exception(call->take_error()), Overloaded);
  }
  CHECK(world.provider(1).calls.size() == 160);
  CHECK(world.provider(2).calls.size() == 14);
}

TEST_CASE("calls that one provider refuses and another answers cost no budget") {
  World world(2);
  world.provider(1).refuses = true;
  for (int i = 0; i < 100; ++i) {
    const auto call = world.call(kIdempotent);
    world.continuations.run_all();
    REQUIRE(world.provider(2).calls.size() == static_cast<std::size_t>(i + 1));
    world.provider(2).answer(static_cast<std::size_t>(i), 5);
    CHECK(call->take_error() == nullptr);
  }
}

TEST_CASE("calls that were lost with their provider are repeated, and later ones pay for it") {
  World world(3, 10ms);
  std::vector<std::shared_ptr<NumberCall>> calls;
  for (int i = 0; i < 100; ++i) calls.push_back(world.call(kIdempotent));
  world.provider(1).lose();
  world.continuations.run_all();
  CHECK(world.provider(2).calls.size() == 100);
  SECTION("they have no second hedge") {
    world.clock.advance(10ms);
    world.continuations.run_all();
    CHECK(world.provider(3).calls.empty());
  }
  SECTION("they are not repeated again") {
    world.provider(2).lose();
    world.continuations.run_all();
    CHECK(world.provider(3).calls.empty());
    for (const auto& call : calls)
      CHECK_THROWS_AS(std::rethrow_exception(call->take_error()), Disconnected);
  }
}

TEST_CASE("calls that were refused as their provider went are repeated, which costs no budget") {
  World world(3);
  for (int i = 0; i < 100; ++i) world.call(kIdempotent);
  world.provider(1).withdraw();
  world.continuations.run_all();
  REQUIRE(world.provider(2).calls.size() == 100);
  for (std::size_t i = 0; i < 100; ++i) world.provider(2).answer(i, 5);
  world.provider(2).refuses = true;
  world.call(kIdempotent);
  world.continuations.run_all();
  CHECK(world.provider(3).calls.size() == 1);
}

TEST_CASE("a call that is not idempotent does not move") {
  World world(2);
  const auto call = world.call(kOther);
  world.provider(1).lose();
  world.continuations.run_all();
  CHECK(world.provider(2).calls.empty());
  CHECK_THROWS_AS(std::rethrow_exception(call->take_error()), Disconnected);
}

TEST_CASE("a call that was cancelled does not move any more, and what comes late is not taken") {
  World world(2);
  const auto call = world.call(kIdempotent);
  SECTION("before its provider fails") {
    call->cancel();
    world.provider(1).lose();
  }
  SECTION("while it moves") {
    world.provider(1).lose();
    call->cancel();
  }
  world.continuations.run_all();
  CHECK(world.provider(2).calls.empty());
  world.provider(1).answer(0, 5);
  CHECK(call->value == 0);
  CHECK_THROWS_AS(std::rethrow_exception(call->take_error()), Cancelled);
}

TEST_CASE("a call that finds no thread to move it ends at its deadline") {
  World world(2);
  const auto call = world.call(kIdempotent);
  world.provider(1).lose();
  world.clock.advance(9s);
  CHECK_FALSE(call->finished());
  world.clock.advance(1s);
  CHECK_THROWS_AS(std::rethrow_exception(call->take_error()), TimedOut);
  world.continuations.run_all();
  CHECK(world.provider(2).calls.empty());
}

TEST_CASE("a call that every provider refuses is tried by four of them at most") {
  World world(9);
  for (const auto& provider : world.providers) provider->refuses = true;
  const auto call = world.call(kIdempotent);
  world.continuations.run_all();
  REQUIRE(call->finished());
  CHECK_THROWS_AS(std::rethrow_exception(call->take_error()), Overloaded);
  std::size_t tries = 0;
  for (const auto& provider : world.providers) tries += provider->calls.size();
  CHECK(tries == 4);
}

namespace {

std::string text_of(NumberCall& call) {
  try {
    std::rethrow_exception(call.take_error());
  } catch (const Error& error) {
    return std::string(to_string(error.code())) + ": " + error.what();
  }
}

}  // namespace

TEST_CASE("a call whose only provider was lost waits, without a thread, until one comes back") {
  World world(1);
  const auto call = world.call(kIdempotent);
  world.provider(1).lose();
  world.continuations.run_all();
  world.clock.advance(9s);
  CHECK(world.continuations.run_all() == 0);
  CHECK_FALSE(call->finished());
  world.restart(1);
  REQUIRE(world.provider(1).calls.size() == 1);
  CHECK(world.provider(1).arguments[0] == 7);
  world.provider(1).answer(0, 5);
  CHECK(call->take_error() == nullptr);
  CHECK(call->value == 5);
}

TEST_CASE(
    "a call that waits for a provider to come back in vain ends at its deadline, and says so") {
  World world(1);
  const auto call = world.call(kIdempotent);
  world.provider(1).lose();
  world.continuations.run_all();
  world.clock.advance(10s);
  REQUIRE(call->finished());
  CHECK(text_of(*call) ==
        "Disconnected: gone; no provider came back while the call waited: nobody is left");
}

TEST_CASE("a call that waits for a provider ends when its caller cancels it, or its entity ends") {
  World world(1);
  const auto call = world.call(kIdempotent);
  world.provider(1).lose();
  world.continuations.run_all();
  SECTION("cancelled") {
    call->cancel();
    CHECK(text_of(*call).starts_with("Cancelled"));
  }
  SECTION("ended") {
    world.channel->lose("this side's entity has ended");
    world.continuations.run_all();
    CHECK(text_of(*call).starts_with("Disconnected: gone; no provider came back"));
  }
  SECTION("nobody holds its connection any more") {
    world.channel.reset();
    world.continuations.run_all();
    CHECK(text_of(*call).starts_with("Cancelled"));
    return;
  }
  world.restart(1);
  CHECK(world.provider(1).calls.empty());
}

TEST_CASE("a call that its next provider refuses at once ends at its deadline if nobody comes") {
  World world(2);
  const auto call = world.call(kIdempotent);
  world.provider(2).while_it_starts = [&] { world.provider(2).withdraw(); };
  world.provider(1).lose();
  world.continuations.run_all();
  CHECK_FALSE(call->finished());
  world.clock.advance(10s);
  CHECK(call->finished());
}

TEST_CASE("a call that was lost for the second time ends, since it may itself be the cause") {
  World world(9);
  const auto call = world.call(kIdempotent);
  world.provider(1).lose();
  world.continuations.run_all();
  REQUIRE(world.provider(2).calls.size() == 1);
  world.provider(2).lose();
  world.continuations.run_all();
  CHECK(world.provider(3).calls.empty());
  CHECK(text_of(*call).ends_with("the request itself may be the cause"));
}

TEST_CASE("a provider that stands and answers with a failure of its own is not asked again") {
  World world(GENERATE(1, 2));
  const auto call = world.call(kIdempotent);
  world.provider(1).calls[0]->fail(std::make_exception_ptr(Disconnected("its own provider died")));
  world.continuations.run_all();
  CHECK(world.provider(1).calls.size() == 1);
  if (world.providers.size() == 1) {
    CHECK(text_of(*call) == "Disconnected: its own provider died");
  } else {
    CHECK(world.provider(2).calls.size() == 1);
  }
}

TEST_CASE("a call that is not idempotent waits for a provider without a thread, too") {
  World world(1);
  world.provider(1).lose();
  const auto call = world.call(kOther);
  world.continuations.run_all();
  SECTION("one comes") {
    world.restart(1);
    world.provider(1).answer(0, 5);
    CHECK(call->value == 5);
  }
  SECTION("none comes") {
    world.clock.advance(10s);
    CHECK(text_of(*call) == "Unavailable: nobody is left");
  }
  SECTION("it is lost with the one that comes") {
    world.restart(1);
    world.provider(1).lose();
    world.restart(1);
    CHECK(text_of(*call) == "Disconnected: gone");
    CHECK(world.provider(1).calls.empty());
  }
}

TEST_CASE("who was lost and comes back is asked once more, where nobody else is available") {
  World world(1);
  const auto call = world.call(kIdempotent);
  world.provider(1).lose();
  world.restart(1);
  REQUIRE(world.provider(1).calls.size() == 1);
  world.provider(1).answer(0, 5);
  CHECK(call->value == 5);
}

TEST_CASE("a failure that another provider would not mend ends the call at once") {
  World world(2);
  const auto call = world.call(kIdempotent);
  world.provider(1).calls[0]->fail(std::make_exception_ptr(InvalidArgument("wrong")));
  CHECK_THROWS_AS(std::rethrow_exception(call->take_error()), InvalidArgument);
}

TEST_CASE("while another provider stands a suspect one gets no new calls", "[R20]") {
  World world(2);
  const OperationInfo& operation = GENERATE(std::cref(kIdempotent), std::cref(kOther)).get();
  const auto on_its_way = world.call(operation);
  *world.provider(1).suspect = true;
  world.call(operation);
  world.continuations.run_all();
  CHECK(world.provider(1).calls.size() == 1);
  CHECK(world.provider(2).calls.size() == 1);
  CHECK_FALSE(on_its_way->finished());

  *world.provider(1).suspect = false;
  *world.provider(2).suspect = true;
  world.call(operation);
  world.continuations.run_all();
  CHECK(world.provider(1).calls.size() == 2);
}

TEST_CASE("with nobody else to ask calls go to a suspect provider", "[R20]") {
  World world(1);
  const OperationInfo& operation = GENERATE(std::cref(kIdempotent), std::cref(kOther)).get();
  world.refusal = GENERATE(ErrorCode::Unavailable, ErrorCode::Overloaded);
  *world.provider(1).suspect = true;
  world.call(operation);
  world.continuations.run_all();
  CHECK(world.provider(1).calls.size() == 1);
}

TEST_CASE(
    "a hedged call without an answer in time is made at a second provider; the first answer "
    "counts, "
    "and the other call is cancelled") {
  World world(3, 50ms);
  const auto call = world.call(kIdempotent);
  world.clock.advance(49ms);
  world.continuations.run_all();
  CHECK(world.provider(2).calls.empty());
  world.clock.advance(1ms);
  world.continuations.run_all();
  REQUIRE(world.provider(2).calls.size() == 1);
  CHECK(world.provider(2).arguments[0] == 7);
  const int quick = GENERATE(1, 2);
  const int slow = 3 - quick;
  world.provider(quick).answer(0, quick);
  CHECK(call->finished());
  CHECK(call->value == quick);
  CHECK(call->take_error() == nullptr);
  CHECK(world.provider(slow).cancelled == 1);
  CHECK(world.provider(quick).cancelled == 0);
  world.provider(slow).answer(0, slow);
  CHECK(call->value == quick);
  world.clock.advance(10s);
  world.continuations.run_all();
  CHECK(world.provider(3).calls.empty());
}

TEST_CASE("a hedged call that is answered in time is made once") {
  World world(2, 50ms);
  const auto call = world.call(kIdempotent);
  world.provider(1).answer(0, 5);
  CHECK(call->value == 5);
  world.clock.advance(1s);
  world.continuations.run_all();
  CHECK(world.provider(2).calls.empty());
}

TEST_CASE("only idempotent calls are hedged") {
  World world(2, 50ms);
  world.call(kOther);
  world.clock.advance(1s);
  world.continuations.run_all();
  CHECK(world.provider(2).calls.empty());
}

TEST_CASE(
    "while one provider has a hedged call it does not matter that the other is lost; when both "
    "are, "
    "it moves on") {
  World world(3, 50ms);
  const auto call = world.call(kIdempotent);
  world.clock.advance(50ms);
  world.continuations.run_all();
  world.provider(1).lose();
  world.continuations.run_all();
  CHECK_FALSE(call->finished());
  CHECK(world.provider(3).calls.empty());
  SECTION("the second one answers") { world.provider(2).answer(0, 5); }
  SECTION("the second one is lost, too") {
    world.provider(2).lose();
    world.continuations.run_all();
    REQUIRE(world.provider(3).calls.size() == 1);
    world.provider(3).answer(0, 5);
  }
  CHECK(call->take_error() == nullptr);
  CHECK(call->value == 5);
}

TEST_CASE("a hedged call that both providers lose is repeated once in any case") {
  World world(3, 10ms);
  std::shared_ptr<NumberCall> call;
  for (std::size_t i = 0; i < RetryBudget::kReserve; ++i) {
    call = world.call(kIdempotent);
    world.clock.advance(10ms);
    world.continuations.run_all();
    REQUIRE(world.provider(2).calls.size() == i + 1);
    if (i + 1 < RetryBudget::kReserve) world.provider(1).answer(i, 5);
  }
  for (const int number : {1, 2}) {
    world.provider(number).lose();
    world.continuations.run_all();
  }
  REQUIRE(world.provider(3).calls.size() == 1);
  world.provider(3).answer(0, 5);
  CHECK(call->take_error() == nullptr);
}

TEST_CASE("a hedged call whose time comes before its provider is known is not made there twice") {
  World world(2, 50ms);
  const auto wait = [&] {
    world.clock.advance(50ms);
    world.continuations.run_all();
  };
  world.provider(1).while_it_starts = wait;
  const auto call = world.call(kIdempotent);
  CHECK(world.provider(1).calls.size() == 1);
  CHECK(world.provider(2).calls.empty());
  wait();
  CHECK(world.provider(1).calls.size() == 1);
  CHECK(world.provider(2).calls.size() == 1);
  world.provider(1).answer(0, 5);
  CHECK(call->value == 5);
}

TEST_CASE("cancelling a hedged call cancels it at both providers") {
  World world(2, 50ms);
  const auto call = world.call(kIdempotent);
  world.clock.advance(50ms);
  world.continuations.run_all();
  call->cancel();
  for (const int number : {1, 2}) CHECK(world.provider(number).cancelled == 1);
}

TEST_CASE("a hedged call with nobody else to ask waits for its provider") {
  World world(1, 50ms);
  const auto call = world.call(kIdempotent);
  world.clock.advance(1s);
  world.continuations.run_all();
  CHECK_FALSE(call->finished());
  world.provider(1).answer(0, 5);
  CHECK(call->value == 5);
}
