#include <catch2/catch.hpp>
#include <thread>

#include "call_port/dds_call_port.hpp"
#include "echo_pair.hpp"
#include "entity/entity_access.hpp"
#include "pairing.hpp"
#include "rpc/client/remote_channel.hpp"
#include "test/tools/eventually.hpp"
#include "test/tools/invariant.hpp"
#include "test/tools/log.hpp"

using namespace skein;
using namespace skein::test;
using namespace std::chrono_literals;
using ::test::DivisionByZero;
using ::test::Echo;
using ::test::LouderEcho;

namespace {

struct Pair : EchoPair<> {
  explicit Pair(const ServiceOptions& options = {})
      : EchoPair(make_server(), make_client(), options) {}

  /// A proxy of the client's, or of one in the server's process.
  Echo::Proxy connect(bool same_process) { return same_process ? server->connect<Echo>() : *echo; }
};

ServiceOptions threads(std::size_t count) {
  ServiceOptions options;
  options.threads = count;
  return options;
}

}  // namespace

TEST_CASE_METHOD(Pair, "a call brings its result back", "[wire]") {
  CHECK(echo->echo("hello") == "hello");
  CHECK(echo->echo("") == "");
  std::int32_t remainder = 0;
  CHECK(echo->divide(17, 5, remainder) == 3);
  CHECK(remainder == 2);
  echo->label("other");
  CHECK(echo->label() == "other");
}

TEST_CASE_METHOD(Pair, "payloads of every size arrive unchanged", "[wire]") {
  for (const std::size_t size : {0u, 1u, 3u, 63u, 1024u, 65'537u, 1'048'576u, 4'194'305u}) {
    std::vector<std::uint8_t> content(size);
    for (std::size_t i = 0; i < size; ++i) content[i] = static_cast<std::uint8_t>(i * 31 + i / 257);
    CAPTURE(size);
    const auto answer = echo->within(30s).echo_octets(content);
    INVARIANT((answer == content));
  }
}

TEST_CASE_METHOD(Pair, "an exception that the interface declares arrives as its own type",
                 "[wire]") {
  std::int32_t remainder;
  try {
    echo->divide(9, 0, remainder);
    FAIL("no exception");
  } catch (const DivisionByZero& exception) {
    CHECK(exception.dividend == 9);
  }
}

TEST_CASE(
    "whatever else an implementation throws arrives as an error with its text, on every "
    "transport") {
  Pair pair;
  auto echo = pair.connect(GENERATE(false, true));
  CHECK_THROWS_AS(echo.fail("overloaded"), Overloaded);
  CHECK_THROWS_WITH(echo.fail("overloaded"), Catch::EndsWith("no room for this one"));
  const std::vector<std::pair<std::string, std::string>> texts{
      {"standard", "'fail' failed: something broke"},
      {"undeclared", "'fail' threw test::DivisionByZero, which its interface does not declare"},
      {"number", "'fail' threw something that is no std::exception"}};
  for (const auto& [how, text] : texts) {
    CAPTURE(how);
    CHECK_THROWS_AS(echo.fail(how), Internal);
    CHECK_THROWS_WITH(echo.fail(how), Catch::EndsWith(text));
    CHECK_THROWS_AS(echo.async_fail(how).get(), Internal);
    CHECK_THROWS_WITH(echo.async_fail(how).get(), Catch::EndsWith(text));
  }
  CHECK(echo.echo("still alive") == "still alive");
}

TEST_CASE_METHOD(
    Pair,
    "an exception that CDR cannot carry arrives as Internal on every transport, and the provider "
    "lives on") {
  auto echo = connect(GENERATE(false, true));
  const std::string how = GENERATE(as<std::string>(), "zero", "long");
  const auto text = Catch::Contains("the exception test::Garbled of 'garble' cannot be sent: ");
  CHECK_THROWS_AS(echo.garble(how), Internal);
  CHECK_THROWS_WITH(echo.garble(how), text);
  CHECK_THROWS_AS(echo.async_garble(how).get(), Internal);
  CHECK_THROWS_WITH(echo.async_garble(how).get(), text);
  CHECK(echo.echo("still alive") == "still alive");
}

TEST_CASE_METHOD(Pair, "an argument that CDR cannot carry is named with its member") {
  const std::string text("a\0b", 3);
  CHECK_THROWS_AS(echo->echo(text), InvalidArgument);
  CHECK_THROWS_WITH(echo->echo(text),
                    "text with a zero byte cannot travel as an IDL string; use sequence<octet> "
                    "(in 'text')");
}

TEST_CASE_METHOD(
    Pair, "a result that CDR cannot carry is answered as Internal where it would have to be sent") {
  CHECK_THROWS_AS(echo->garble("result"), Internal);
  CHECK_THROWS_WITH(
      echo->garble("result"),
      Catch::Contains("the result of 'garble' cannot be sent: text with a zero byte "
                      "cannot travel as an IDL string; use sequence<octet> (in 'return_')"));
  auto stream = echo->mumble();
  CHECK(stream.next() == "clear");
  CHECK_THROWS_WITH(stream.next(), Catch::Contains("a result of 'mumble' cannot be sent: "));
  CHECK_THROWS_AS(
      [&] {
        auto again = echo->mumble();
        while (again.next()) {
        }
      }(),
      Internal);
  CHECK(echo->echo("still alive") == "still alive");
  CHECK(connect(true).garble("result").size() == 8);
}

TEST_CASE("calls from several threads do not disturb each other", "[wire]") {
  Pair pair(threads(4));
  std::vector<std::thread> callers;
  std::atomic<int> right = 0;
  for (int caller = 0; caller < 8; ++caller) {
    callers.emplace_back([&, caller] {
      for (int i = 0; i < 50; ++i) {
        const std::string text = std::to_string(caller) + ":" + std::to_string(i);
        auto echo = pair.echo->within(30s);
        right += (i % 3 == 0 ? echo.async_echo(text).get() : echo.echo(text)) == text;
      }
    });
  }
  for (std::thread& caller : callers) caller.join();
  CHECK(right == 400);
  INVARIANT(pair.service->calls <= 400);
  CHECK(pair.service->calls == 400);
}

TEST_CASE("a service with one thread is never inside two calls at once, one with more may be") {
  Pair one;
  Pair four(threads(4));
  const auto call_four_times = [](Echo::Proxy echo, std::uint32_t time_ms) {
    std::vector<Call<bool>> calls;
    for (int i = 0; i < 4; ++i) calls.push_back(echo.within(10min).async_wait(time_ms));
    return calls;
  };
  const auto at_once = call_four_times(four.client->connect<Echo>({.provider = four.id}), 600'000);
  CHECK(eventually([&] { return four.service->inside == 4; }));
  auto in_turn = call_four_times(one.client->connect<Echo>({.provider = one.id}), 20);
  for (auto& call : in_turn) CHECK(call.get());
  CHECK_FALSE(one.service->overlapped);
}

TEST_CASE(
    "dropping, cancelling, timing out and disconnecting each reach the running call, on every "
    "transport",
    "[wire]") {
  const auto server = make_server();
  const auto service = std::make_shared<EchoService>();
  server->provide<LouderEcho>(service);
  const bool same_process = GENERATE(false, true);
  const auto client = same_process ? nullptr : make_client();
  auto echo = (client ? *client : *server).connect<Echo>();
  std::optional<Call<bool>> call(echo.within(10min).async_wait(600'000));
  SECTION("dropping") {
    REQUIRE(eventually([&] { return service->inside == 1; }));
    call.reset();
  }
  SECTION("cancelling") {
    REQUIRE(eventually([&] { return service->inside == 1; }));
    call->cancel();
    CHECK_THROWS_AS(call->get(), Cancelled);
  }
  SECTION("timing out") {
    call.reset();
    REQUIRE(eventually([&] { return service->inside == 0; }));
    service->saw_cancellation = false;
    const bool blocking = GENERATE(false, true);
    const auto before = service->calls.load();
    REQUIRE(with_enough_time(200ms, [&](auto limit) {
      auto hurried = echo.within(limit);
      if (blocking) {
        CHECK_THROWS_AS(hurried.wait(600'000), TimedOut);
      } else {
        CHECK_THROWS_AS(hurried.async_wait(600'000).get(), TimedOut);
      }
      return service->calls > before;
    }));
  }
  SECTION("disconnecting") {
    REQUIRE(eventually([&] { return service->inside == 1; }));
    echo.disconnect();
    CHECK_THROWS_AS(call->get(), Cancelled);
  }
  CHECK(eventually([&] { return service->saw_cancellation && service->inside == 0; }));
}

TEST_CASE_METHOD(Pair, "an asynchronous call can be waited for, continued and cancelled") {
  CHECK(echo->async_echo("later").get() == "later");

  std::atomic<bool> continued = false;
  echo->async_echo("then").then([&](Call<std::string> call) { continued = call.get() == "then"; });
  CHECK(eventually([&] { return continued.load(); }));

  auto cancelled = echo->within(60s).async_wait(60'000);
  cancelled.cancel();
  CHECK_THROWS_AS(cancelled.get(), Cancelled);
}

TEST_CASE_METHOD(
    Pair, "what a continuation throws is told as the continuation's, and the next one runs") {
  const Log log;
  const bool standard = GENERATE(true, false);
  echo->async_echo("x").then([standard](Call<std::string>) {
    if (standard) throw std::runtime_error("oops");
    throw 42;
  });
  std::atomic<bool> continued = false;
  echo->async_echo("x").then([&](Call<std::string>) { continued = true; });
  CHECK(eventually([&] { return continued.load(); }));
  CHECK(log.count(std::string("a continuation of Call::then threw: ") +
                  (standard ? "oops" : "something that is no std::exception")) == 1);
}

TEST_CASE_METHOD(Pair, "a time limit that has passed before any call is refused") {
  CHECK_THROWS_AS(echo->within(-1s), InvalidArgument);
  CHECK_THROWS_WITH(echo->within(-1s),
                    "within() is given -1000 ms; a call takes a time limit from 0 on, and ends as "
                    "TimedOut after it");
  CHECK_THROWS_AS(echo->within(0s).echo("x"), TimedOut);
}

TEST_CASE_METHOD(Pair, "a limit may be longer than any clock counts", "[wire]") {
  for (const TimeSpan limit : {TimeSpan(Duration::max()), TimeSpan(std::chrono::hours::max())}) {
    const auto patient = client->connect<Echo>({.timeout = limit}).within(limit);
    CHECK(patient.echo("x") == "x");
    CHECK(patient.who(0) == "echo");
    CHECK(patient.async_echo("y").get() == "y");
    auto numbers = patient.count_up(3, -1);
    while (numbers.next()) {
    }
  }
  CHECK(server->drain(Duration::max()));
}

TEST_CASE_METHOD(Pair, "a proxy that nothing was assigned to, or that was moved from, says so") {
  const std::string told =
      "this proxy is not connected: it was made without a connection, or moved from; assign what "
      "connect() returns";
  Echo::Proxy later;
  CHECK_THROWS_WITH(later.echo("x"), told);
  CHECK_THROWS_WITH(later.within(1s).async_echo("x"), told);
  CHECK_THROWS_WITH(later.count_up(1, -1), told);
  CHECK_NOTHROW(later.disconnect());
  later = *echo;
  const auto take = [](Echo::Proxy& from) { return std::move(from); };
  const Echo::Proxy moved = take(later);
  CHECK(moved.echo("x") == "x");
  CHECK_THROWS_WITH(later.echo("x"), told);
}

TEST_CASE_METHOD(Pair, "a call is used once, and says so the second time") {
  auto call = echo->async_echo("once");
  CHECK(call.get() == "once");
  CHECK_THROWS_AS(call.get(), InvalidArgument);
  CHECK_THROWS_AS(call.cancel(), InvalidArgument);
  CHECK_THROWS_WITH(call.ready(), Catch::Contains("used before"));
}

TEST_CASE_METHOD(Pair, "oneway calls are executed in order without an answer", "[wire]") {
  for (int i = 0; i < 20; ++i) echo->note("n");
  CHECK(eventually([&] { return echo->noted() == 20; }));
}

TEST_CASE(
    "calls beyond a service's queue are refused as Overloaded, and none of them is executed") {
  ServiceOptions options;
  options.queue = 4;  // half of it for one client
  Pair pair(options);
  auto running = pair.echo->within(60s).async_wait(60'000);
  REQUIRE(eventually([&] { return pair.service->inside == 1; }));
  std::vector<Call<std::string>> calls;
  for (int i = 0; i < 6; ++i) calls.push_back(pair.echo->within(30s).async_echo("x"));
  REQUIRE(eventually([&] {
    return calls[2].ready() && calls[3].ready() && calls[4].ready() && calls[5].ready();
  }));
  for (int i = 2; i < 6; ++i) CHECK_THROWS_AS(calls[i].get(), Overloaded);
  running.cancel();
  for (int i = 0; i < 2; ++i) CHECK(calls[i].get() == "x");
  CHECK(pair.service->calls == 3);
}

TEST_CASE_METHOD(Pair, "calls beyond a connection's limit are refused as Overloaded and not sent") {
  calls::DdsCallPort port(EntityAccess::participant(*client));
  ThreadExecutor control("control");
  rpc::RemoteChannel::Options options;
  options.peer = "server";
  options.calls_in_flight = 2;
  Echo::Proxy echo(rpc::RemoteChannel::open(
      port, control, std::make_shared<ThreadExecutor>("continue"), std::make_shared<SystemClock>(),
      {std::string(LouderEcho::interface_info().name), id}, options));
  auto first = echo.within(60s).async_wait(60'000);
  auto second = echo.within(60s).async_wait(60'000);
  CHECK_THROWS_AS(echo.echo("third"), Overloaded);
  CHECK_THROWS_WITH(echo.echo("third"),
                    Catch::Contains("2 calls to server") && Catch::Contains("was not sent"));
  first.cancel();
  second.cancel();
  CHECK(echo.within(30s).echo("fourth") == "fourth");
  CHECK(service->calls <= 3);
}

TEST_CASE_METHOD(
    Pair, "a service whose threads can never run as told is not provided, and the entity goes on") {
  ServiceOptions options;
  options.scheduling.cpus = {4000};
  CHECK_THROWS_WITH(server->provide<LouderEcho>(service, options), Catch::Contains("no CPU 4000"));
  CHECK(echo->echo("still here") == "still here");
}

TEST_CASE_METHOD(Pair, "a service that cannot work is refused with the reason") {
  const auto provide = [&](const std::string& name, const std::string& owner,
                           const ServiceOptions& options = {}) {
    server->provide_csp<Echo>(name, owner, service, options);
  };
  CHECK_THROWS_WITH(server->provide<LouderEcho>(nullptr),
                    Catch::Contains("'server' has no implementation"));
  CHECK_THROWS_WITH(provide("csp", "owner"), Catch::Contains("SYSTEM/ENTITY"));
  CHECK_THROWS_WITH(provide("csp", "uav-1/owner", {.attributes = {{"latency", "quick"}}}),
                    Catch::Contains("latency of 'csp' is 'quick'"));
  CHECK_THROWS_WITH(provide("csp", "uav-1/owner", {.attributes = {{"quality", "3 s"}}}),
                    Catch::Contains("quality of 'csp' is '3 s'"));
  CHECK_THROWS_WITH(provide("csp", "uav-1/owner", {.attributes = {{"latency", -5}}}),
                    Catch::Contains("latency of 'csp' is '-5'"));
  CHECK_THROWS_WITH(provide("csp", "uav-1/owner", {.queue = 0}), Catch::Contains("a `queue` of 0"));
  provide("csp", "uav-1/owner");
  CHECK_THROWS_WITH(provide("csp", "uav-1/owner"), Catch::Contains("another name"));
  CHECK_NOTHROW(provide("csp", "uav-1/other"));
}

TEST_CASE_METHOD(
    Pair,
    "connecting by interface, entity and base finds the provider; what is not there gives the "
    "reason") {
  CHECK(client->connect<LouderEcho>().shout("hey") == "HEY");
  CHECK(client->connect<Echo>({.name = "server"}).echo("x") == "x");
  CHECK(client->connect<Echo>({.name = "test::LouderEcho"}).echo("x") == "x");
  CHECK_THROWS_AS(client->connect<Echo>({.name = "sever", .timeout = 50ms}), Unavailable);
  CHECK_THROWS_WITH(client->connect<Echo>({.name = "sever", .timeout = 50ms}),
                    Catch::Contains("did you mean 'server'"));
  CHECK_THROWS_WITH(client->connect<Echo>({.system = "uav-9", .timeout = 50ms}),
                    Catch::Contains("system 'uav-9'"));
  CHECK_THROWS_WITH(client->connect<Echo>({.name = "nobody", .timeout = 50ms}),
                    Catch::Contains("in domain 17 on 127.0.0.1") ||
                        Catch::Contains("in domain 17 of the loopback network"));
}

TEST_CASE(
    "connecting with constraints finds a provider that declares so; otherwise each one's reason is "
    "given") {
  ServiceOptions options;
  options.attributes = {{"latency", "500"}};
  Pair pair(options);
  CHECK(pair.client
            ->connect<Echo>({.constraints = {{"latency", Relation::AtMost, "500"}},
                             .preferred_host = ConnectOptions::kOwnHost})
            .echo("x") == "x");
  CHECK_THROWS_WITH(
      pair.client->connect<Echo>(
          {.constraints = {{"latency", Relation::AtMost, "300"}}, .timeout = 50ms}),
      Catch::Contains("server (uav-1) does not suit: its latency is 500, not at most 300"));
  CHECK_THROWS_AS(
      pair.client->connect<Echo>({.constraints = {{"latency", Relation::AtMost, "soon"}}}),
      InvalidArgument);
}

TEST_CASE("a provider of another wire is not called, and its callers learn why", "[R30]") {
  const auto server = make_server();
  server->provide<Echo>(std::make_shared<EchoService>(), {.attributes = {{"skein:wire", "7"}}});
  CHECK_THROWS_WITH(
      make_client()->connect<Echo>({.timeout = 50ms}),
      Catch::Contains("server (uav-1) runs a version of Skein whose wire is number 7, "
                      "and here it is number 1"));
}

TEST_CASE("an attribute's value may be a text, a number or a duration") {
  Pair pair({.attributes = {{"latency", 20ms}, {"quality", 0.9}, {"kind", "grid"}}});
  CHECK(pair.client
            ->connect<Echo>({.constraints = {{"latency", Relation::Equal, "20 ms"},
                                             {"quality", Relation::AtLeast, 0.9},
                                             {"kind", Relation::Equal, "grid"}}})
            .echo("x") == "x");
}

TEST_CASE_METHOD(Pair, "no time to connect in is refused") {
  const std::string told = "in which no provider can be found; give it some time, as 5s";
  CHECK_THROWS_WITH(client->connect<Echo>({.timeout = 0s}), Catch::EndsWith("of 0 ms, " + told));
  CHECK_THROWS_WITH(client->connect<Echo>({.timeout = -1s}), Catch::EndsWith(told));
  CHECK_THROWS_WITH(client->connect<Echo>({.timeout = 0s, .foreign = true}), Catch::EndsWith(told));
  CHECK_THROWS_WITH(client->connect_all<Echo>({.timeout = 0s}), Catch::EndsWith(told));
}

TEST_CASE_METHOD(Pair, "hedging for which there is no operation is told of") {
  struct Introducing : ::test::Introducer {
    Reference<Echo> introduce() override { return {}; }
    std::string ask(const Reference<Echo>&, const std::string&) override { return {}; }
  };
  const Log log;
  const auto hedged = client->connect<Echo>({.hedge_after = 20ms});
  CHECK(log.count("`hedge_after` has no effect") == 0);
  server->provide<::test::Introducer>(std::make_shared<Introducing>());
  const auto plain = client->connect<::test::Introducer>({.hedge_after = 20ms});
  CHECK(log.count("`hedge_after` has no effect: no operation of test::Introducer is declared "
                  "@idempotent") == 1);
}

TEST_CASE_METHOD(Pair,
                 "a client with another version of the interface is told which operation differs") {
  CHECK_THROWS_WITH(client->connect<changed::Echo>({.name = "test::Echo", .timeout = 50ms}),
                    Catch::Contains("another version") && Catch::Contains("'echo'"));
}

TEST_CASE_METHOD(Pair,
                 "a session with an unknown selection strategy is refused with the known ones") {
  CHECK_THROWS_WITH(
      client->connect<Echo>({.strategy = "declard", .timeout = 5s}),
      Catch::Contains("unknown selection strategy") && Catch::Contains("did you mean 'declared'"));
  CHECK(client->connect<Echo>({.strategy = "fixed_order"}).echo("x") == "x");
}

TEST_CASE("a service reference can be returned, passed on and connected to", "[wire]") {
  struct Introducer : ::test::Introducer {
    explicit Introducer(Entity& own) : entity(own) {}
    Reference<Echo> introduce() override { return introduced; }
    std::string ask(const Reference<Echo>& whom, const std::string& text) override {
      return entity.connect(whom).echo(text);
    }
    Entity& entity;
    Reference<Echo> introduced;
  };
  const auto server = make_server();
  const auto introducer = std::make_shared<Introducer>(*server);
  const auto other = make_entity("other", Pairing::get().client, "uav-2");
  introducer->introduced =
      other->reference<Echo>(other->provide<LouderEcho>(std::make_shared<EchoService>()));
  server->provide<::test::Introducer>(introducer);
  const auto client = make_client();
  auto proxy = client->connect<::test::Introducer>();

  const Reference<Echo> reference = proxy.introduce();
  CHECK(reference == introducer->introduced);
  CHECK(client->connect(reference).echo("by reference") == "by reference");
  CHECK(proxy.ask(reference, "passed on") == "passed on");
  CHECK_THROWS_AS(client->connect(Reference<Echo>()), InvalidArgument);
}

TEST_CASE_METHOD(Pair, "a disconnected proxy refuses calls") {
  echo->disconnect();
  CHECK_THROWS_AS(echo->echo("x"), Unavailable);
}

TEST_CASE_METHOD(Pair, "a proxy that outlives its entity says so") {
  client.reset();
  CHECK_THROWS_WITH(
      echo->echo("x"),
      Catch::Contains("it was disconnected, or the entity that had connected has ended"));
}

TEST_CASE_METHOD(Pair, "a managed service is closed to strangers", "[wire]") {
  server->provide_csp<Echo>("hidden", "uav-1/owner", std::make_shared<EchoService>());
  CHECK_THROWS_AS(client->connect<Echo>({.name = "hidden", .timeout = 100ms}), Unavailable);

  const auto owner = make_entity("owner", Pairing::get().client);
  CHECK(owner->connect<Echo>({.name = "hidden"}).echo("mine") == "mine");
}

TEST_CASE("within one process a call stays in it and runs on the thread that is declared") {
  const auto process = std::make_shared<Process>();
  const auto server = make_entity("server", Pairing::get().server, "uav-1", process);
  const auto client = make_entity("client", Pairing::get().client, "uav-1", process);
  struct Where : EchoService {
    std::string echo(const std::string&) override {
      ran_on = std::this_thread::get_id();
      return "";
    }
    std::thread::id ran_on;
  };
  const auto service = std::make_shared<Where>();
  const CallThread thread = GENERATE(CallThread::Own, CallThread::Caller);
  server->provide<LouderEcho>(service, {.thread = thread});
  auto echo = client->connect<Echo>();
  echo.echo("x");
  CHECK((service->ran_on == std::this_thread::get_id()) == (thread == CallThread::Caller));
  std::int32_t remainder;
  CHECK_THROWS_AS(echo.divide(1, 0, remainder), DivisionByZero);
  CHECK_THROWS_AS(echo.within(30ms).async_wait(5'000).get(), TimedOut);
}

TEST_CASE("an entity withdraws its own services and no others of its process", "[wire]") {
  const auto process = std::make_shared<Process>();
  const auto server = make_entity("server", Pairing::get().server, "uav-1", process);
  const auto client = make_entity("client", Pairing::get().server, "uav-1", process);
  const Guid id = server->provide<LouderEcho>(std::make_shared<EchoService>());
  client->withdraw(id);
  CHECK_THAT(client->connect<Echo>().channel()->peer(), Catch::Contains("in this process"));
  server->withdraw(id);
  CHECK_THROWS_AS(server->connect<Echo>({.timeout = 50ms}), Unavailable);
}

TEST_CASE("a call that would wait for itself is refused with the reason") {
  struct Recursive : EchoService {
    std::string echo(const std::string& text) override {
      std::unique_lock lock(mutex);
      auto proxy = *self;
      lock.unlock();
      return proxy.echo(text);
    }
    void connect_to(Entity& entity) {
      auto proxy = entity.connect<Echo>();
      std::lock_guard lock(mutex);
      self.emplace(std::move(proxy));
    }
    void forget() {
      std::lock_guard lock(mutex);
      self.reset();
    }
    std::mutex mutex;  // a sanitizer does not see that a message travels between the two threads
    std::optional<Echo::Proxy> self;
  };
  const auto server = make_server();
  const auto service = std::make_shared<Recursive>();
  server->provide<LouderEcho>(service);
  const auto client = make_client();
  SECTION("within the process") { service->connect_to(*server); }
  SECTION("through another entity") { service->connect_to(*client); }
  CHECK_THROWS_WITH(service->self->echo("x"), Catch::Contains("wait for itself"));
  service->forget();
}
