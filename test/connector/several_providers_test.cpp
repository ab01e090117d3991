#include <catch2/catch.hpp>
#include <set>

#include "brokerless_discovery/broker.hpp"
#include "echo_service.hpp"
#include "failover/fake_provider.hpp"
#include "pairing.hpp"
#include "skein/gather.hpp"
#include "test/tools/eventually.hpp"

using namespace skein;
using namespace skein::test;
using namespace std::chrono_literals;
using ::test::DivisionByZero;
using ::test::Echo;
using ::test::LouderEcho;

namespace {

/// Answers after its own time, whatever it is asked, and not before another one is busy.
struct PacedEcho : EchoService {
  PacedEcho(std::string name, std::uint32_t time_ms)
      : EchoService(std::move(name)), time_ms_(time_ms) {}
  std::string who(std::uint32_t) override {
    if (other_) eventually([&] { return other_->calls > 0; });
    return EchoService::who(time_ms_);
  }
  void wait_for(std::shared_ptr<EchoService> other) { other_ = std::move(other); }

 private:
  std::shared_ptr<EchoService> other_;
  const std::uint32_t time_ms_;
};

constexpr std::uint32_t kForEver = 600'000;

/// Providers by name, and the time that each takes. Where the first one never answers, the others
/// do so only once it has begun.
struct Crowd {
  explicit Crowd(const std::vector<std::pair<std::string, std::uint32_t>>& members) {
    for (const auto& [name, time_ms] : members) {
      servers.push_back(make_server(name));
      services.push_back(std::make_shared<PacedEcho>(name, time_ms));
      if (time_ms != kForEver && members.front().second == kForEver)
        services.back()->wait_for(services.front());
      servers.back()->provide<LouderEcho>(services.back());
    }
    REQUIRE(eventually([&] {
      return client->broker().find_service(client->broker().query("test::Echo")).size() ==
             members.size();
    }));
  }

  std::vector<std::shared_ptr<PacedEcho>> services;
  std::vector<std::unique_ptr<Entity>> servers;
  std::unique_ptr<Entity> client = make_client();
};

const auto who = [](Echo::Proxy& echo) { return echo.within(10min).async_who(0); };

}  // namespace

TEST_CASE("a call to all gathers the answer of each", "[wire]") {
  Crowd crowd({{"a", 100}, {"b", 0}, {"c", 50}});
  auto all = crowd.client->connect_all<Echo>();
  REQUIRE(all.size() == 3);
  const auto answers = gather(all, all.size(), who);
  REQUIRE(answers.size() == 3);
  std::set<std::string> names;
  for (const auto& answer : answers) {
    CHECK(answer.result == answer.entity);
    CHECK(answer.error == nullptr);
    names.insert(answer.entity);
  }
  CHECK(names == std::set<std::string>{"a", "b", "c"});
}

TEST_CASE("what was gathered stands in the order in which it came") {
  struct Numbers {
    using Proxy = std::shared_ptr<FakeChannel>;
  };
  struct NumberCall final : PendingCall {
    NumberCall(const OperationInfo& operation, Instant deadline)
        : PendingCall(operation, &value, deadline, false) {}
    int value = 0;
  };
  ManualClock clock;
  ManualExecutor continuations;
  const OperationInfo operation = number_operation(true);
  std::vector<Connected<Numbers>> all;
  for (const char* name : {"a", "b", "c"})
    all.push_back({Guid::random(), name, std::make_shared<FakeChannel>(clock, continuations)});
  const auto answers = gather(all, 3, [&](const std::shared_ptr<FakeChannel>& provider) {
    const auto call = std::make_shared<NumberCall>(operation, clock.now() + 1s);
    const int in = 0;
    provider->start(call, &in);
    if (provider == all.back().proxy) {
      all[1].proxy->answer(0, 20);
      all[0].proxy->lose();
      provider->answer(0, 30);
    }
    return Call<int>(call, provider, &call->value);
  });
  REQUIRE(answers.size() == 3);
  CHECK(answers[0].entity == "b");
  CHECK(answers[0].result == 20);
  CHECK(answers[1].entity == "a");
  CHECK_THROWS_AS(std::rethrow_exception(answers[1].error), Disconnected);
  CHECK(answers[2].entity == "c");
  CHECK(answers[2].result == 30);
}

TEST_CASE(
    "a call to all waits no longer than for enough results, and the other calls are cancelled") {
  Crowd crowd({{"a", kForEver}, {"b", 0}, {"c", 0}});
  auto all = crowd.client->connect_all<Echo>();
  const auto answers = gather(all, 2, who);
  REQUIRE(answers.size() == 2);
  for (const auto& answer : answers) CHECK(answer.entity != "a");
  CHECK(eventually([&] { return crowd.services[0]->saw_cancellation.load(); }));
}

TEST_CASE(
    "who does not answer by the deadline, or fails, stands among the answers with his error") {
  Crowd crowd({{"a", kForEver}, {"b", 0}});
  auto all = crowd.client->connect_all<Echo>();
  std::vector<Answer<std::string>> late;
  REQUIRE(with_enough_time(500ms, [&](auto limit) {
    late = gather(all, 2, [&](Echo::Proxy& echo) { return echo.within(limit).async_who(0); });
    return late.size() == 2 && late[0].result;
  }));
  CHECK(late[0].result == std::string("b"));
  CHECK_FALSE(late[1].result);
  CHECK_THROWS_AS(std::rethrow_exception(late[1].error), TimedOut);

  REQUIRE(eventually([&] { return crowd.services[0]->inside == 0; }));
  const auto failed = gather(all, 1, [](Echo::Proxy& echo) { return echo.async_divide(1, 0); });
  REQUIRE(failed.size() == 2);
  for (const auto& answer : failed)
    CHECK_THROWS_AS(std::rethrow_exception(answer.error), DivisionByZero);
}

TEST_CASE("an operation without a result can be gathered, too") {
  Crowd crowd({{"a", 0}, {"b", 0}});
  auto all = crowd.client->connect_all<Echo>();
  const auto answers = gather(all, 2, [](Echo::Proxy& echo) { return echo.async_label("set"); });
  REQUIRE(answers.size() == 2);
  for (const auto& answer : answers) CHECK(answer.result);
}

TEST_CASE("connecting to all with nobody there says why") {
  const auto client = make_client();
  CHECK_THROWS_AS(client->connect_all<Echo>({.timeout = 50ms}), Unavailable);
}

TEST_CASE(
    "a hedged call to a slow provider is answered by the second one, and the slow one hears that "
    "nobody waits") {
  Crowd crowd({{"a", kForEver}, {"b", 0}});
  auto echo = crowd.client->connect<Echo>({.hedge_after = 20ms});
  SECTION("its caller waits") { CHECK(echo.within(10min).who(0) == "b"); }
  SECTION("its caller does not wait") { CHECK(echo.within(10min).async_who(0).get() == "b"); }
  CHECK(eventually([&] { return crowd.services[0]->saw_cancellation.load(); }));
}

TEST_CASE("a connection is opened to the provider that is less loaded", "[R22]") {
  Crowd crowd({{"a", kForEver}, {"b", 0}});
  auto busy = crowd.client->connect<Echo>().within(10min).async_who(0);
  REQUIRE(eventually([&] { return crowd.services[0]->inside == 1; }));
  CHECK(eventually([&] {
    auto echo = crowd.client->connect<Echo>();
    return echo.channel()->peer().find(" of b ") != std::string::npos;
  }));
  busy.cancel();
  CHECK(eventually([&] {
    auto echo = crowd.client->connect<Echo>();
    return echo.channel()->peer().find(" of a ") != std::string::npos;
  }));
}
