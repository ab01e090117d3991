#include <fcntl.h>
#include <pthread.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <catch2/catch.hpp>
#include <deque>
#include <filesystem>
#include <fstream>
#include <mutex>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "../tools/eventually.hpp"
#include "../tools/log.hpp"
#include "brokerless_discovery/broker.hpp"
#include "core/file_descriptor.hpp"
#include "echo_service.hpp"
#include "loopback_entity.hpp"
#include "same_host/ring.hpp"
#include "skein/error.hpp"

using namespace skein;
using namespace skein::test;
using namespace std::chrono_literals;
using ::test::Echo;
using ::test::LouderEcho;

namespace {

std::string thread_name() {
  char name[16] = {};
  pthread_getname_np(pthread_self(), name, sizeof name);
  return name;
}

/// Says on which thread it runs.
struct Placed final : EchoService {
  std::string echo(const std::string&) override { return thread_name(); }
  void burst(std::uint32_t, StreamSink<std::vector<std::uint8_t>>& sink) override {
    const std::string name = thread_name();
    sink.push({name.begin(), name.end()});
  }
};

/// How often threads of this process with that name have slept.
std::uint64_t wake_ups_of(const std::string& name) {
  std::uint64_t wake_ups = 0;
  for (const auto& task : std::filesystem::directory_iterator("/proc/self/task")) {
    std::ifstream file(task.path() / "status");
    bool meant = false;
    for (std::string line; std::getline(file, line);) {
      if (line == "Name:\t" + name) meant = true;
      if (meant && line.starts_with("voluntary_ctxt_switches:"))
        wake_ups += std::stoull(line.substr(line.find('\t')));
    }
  }
  return wake_ups;
}

/// Calls until they run where they arrive: on the thread that takes requests, or on the service's
/// own, which takes them itself then. On a busy machine some are not quick enough at first.
bool runs_on_arrival(Echo::Proxy& echo, CallThread thread) {
  return eventually([&] {
    if (thread == CallThread::Caller) return echo.within(20s).echo("") == "skein-requests";
    constexpr int kCalls = 60;
    const std::uint64_t before = wake_ups_of("skein-requests");
    const auto begin = std::chrono::steady_clock::now();
    for (int i = 0; i < kCalls; ++i) {
      if (echo.within(20s).echo("") == "skein-requests") return false;
    }
    // It stands by, and looks every 10 ms.
    const auto looks = (std::chrono::steady_clock::now() - begin) / 10ms;
    return wake_ups_of("skein-requests") < before + looks + kCalls / 4;
  });
}

std::vector<std::string> transports(const Entity& entity) {
  std::vector<std::string> names;
  for (const auto& each : const_cast<Entity&>(entity).connector().connections()) {
    names.push_back(each.transport);
  }
  return names;
}

/// Writes what a hostile provider would into all rings for replies of this process. By the kernel:
/// who finds the damage ends its mapping meanwhile.
void damage_replies() {
  std::ifstream maps("/proc/self/maps");
  const FileDescriptor memory(open("/proc/self/mem", O_RDWR | O_CLOEXEC));
  const auto write = [&](auto& word, auto value) {
    return pwrite(memory.get(), &value, sizeof value,
                  static_cast<off_t>(reinterpret_cast<std::uintptr_t>(&word))) == sizeof value;
  };
  int damaged = 0;
  for (std::string line; std::getline(maps, line);) {
    if (line.find("memfd:skein") == std::string::npos) continue;
    auto& replies = reinterpret_cast<same_host::RingState*>(std::stoull(line, nullptr, 16))[1];
    if (write(replies.written, std::uint64_t{12})) ++damaged;
    for (auto* word : {&replies.reader_sleeps, &replies.caller_sleeps}) {
      write(*word, std::uint32_t{0});
      same_host::futex_wake(*word);
    }
  }
  REQUIRE(damaged > 0);
}

}  // namespace

TEST_CASE("calls go through shared memory where both sides are told to, and over DDS otherwise") {
  const bool by_server = GENERATE(false, true);
  const bool by_client = GENERATE(false, true);
  const auto server = make_entity("server", by_server);
  server->provide<LouderEcho>(std::make_shared<EchoService>());
  const auto client = make_entity("client", by_client);
  auto echo = client->connect<Echo>();
  CHECK(echo.echo("hello") == "hello");
  const auto connections = client->connector().connections();
  REQUIRE(connections.size() == 1);
  CHECK(connections.front().transport == (by_server && by_client ? "shared memory" : "DDS"));
  CHECK(connections.front().not_faster ==
        (!by_client   ? "the caller does not use shared memory for calls"
         : !by_server ? "the provider does not use shared memory for calls"
                      : ""));
}

TEST_CASE("a provider says in its description whether it is called through shared memory",
          "[R29]") {
  const bool by_server = GENERATE(false, true);
  const auto server = make_entity("server", by_server);
  server->provide<LouderEcho>(std::make_shared<EchoService>());
  const auto& broker = server->broker();
  const auto found = broker.find_service(broker.query("test::Echo"));
  REQUIRE(found.size() == 1);
  CHECK(brokerless_discovery::offers_shared_memory_calls(*found.front()) == by_server);
}

TEST_CASE("a provider that only says that it is called through shared memory is called over DDS",
          "[R29]") {
  const auto server = make_entity("server", false);
  ServiceOptions options;
  options.attributes = {{"skein:shared_memory_calls", "true"}};
  server->provide<LouderEcho>(std::make_shared<EchoService>(), options);
  const auto client = make_entity("client", true);
  auto echo = client->connect<Echo>();
  CHECK(echo.echo("hello") == "hello");
  const auto connections = client->connector().connections();
  REQUIRE(connections.size() == 1);
  CHECK(connections.front().transport == "DDS");
  CHECK(connections.front().not_faster == "no connection through shared memory: nobody offers one");
}

TEST_CASE(
    "a call runs on the thread that takes it where the service says so and has shown that it is "
    "quick, a stream never") {
  const auto server = make_entity("server", true);
  ServiceOptions options;
  const bool on_caller = GENERATE(false, true);
  if (on_caller) options.thread = CallThread::Caller;
  server->provide<LouderEcho>(std::make_shared<Placed>(), options);
  const auto client = make_entity("client", true);
  auto echo = client->connect<Echo>();
  for (int i = 0; i < 100; ++i) CHECK(echo.echo("") == "server");
  // On a busy machine one of them took longer than a quick one may.
  if (on_caller) CHECK(eventually([&] { return echo.echo("") == "skein-requests"; }));
  if (!on_caller) CHECK(echo.echo("") == "server");
  auto stream = echo.burst(1);
  const auto name = stream.next();
  REQUIRE(name);
  CHECK(std::string(name->begin(), name->end()) == "server");
}

TEST_CASE("a call that takes long on the thread that takes it holds up no other service") {
  const auto server = make_entity("server", true);
  const CallThread thread = GENERATE(CallThread::Own, CallThread::Caller);
  const ServiceOptions options{.thread = thread};
  const auto slow = std::make_shared<Placed>();
  const auto slow_id = server->provide<LouderEcho>(slow, options);
  const auto quick_id = server->provide<LouderEcho>(std::make_shared<Placed>(), options);
  const auto client = make_entity("client", true);
  auto slow_echo = client->connect<Echo>({.provider = slow_id});
  auto quick_echo = client->connect<Echo>({.provider = quick_id});
  REQUIRE(runs_on_arrival(slow_echo, thread));
  REQUIRE(runs_on_arrival(quick_echo, thread));
  auto call = slow_echo.within(60s).async_wait(600'000);
  REQUIRE(eventually([&] { return slow->inside == 1; }));
  CHECK(runs_on_arrival(quick_echo, thread));
  CHECK(client->connect<Echo>({.provider = quick_id}).within(20s).echo("") != "");
  CHECK(slow->inside == 1);
  CHECK(transports(*client) == std::vector<std::string>(2, "shared memory"));
}

TEST_CASE(
    "a call that takes long on the thread that takes it hears of its end, and newcomers get in") {
  const auto server = make_entity("server", true);
  const CallThread thread = GENERATE(CallThread::Own, CallThread::Caller);
  const ServiceOptions options{.thread = thread};
  const auto service = std::make_shared<Placed>();
  server->provide<LouderEcho>(service, options);
  const auto client = make_entity("client", true);
  auto echo = client->connect<Echo>();
  for (int i = 0; i < 3; ++i) {
    REQUIRE(runs_on_arrival(echo, thread));
    service->saw_cancellation = false;
    auto call = echo.within(60s).async_wait(600'000);
    REQUIRE(eventually([&] { return service->inside == 1; }));
    const auto newcomer = make_entity("newcomer", true);
    auto other = newcomer->connect<Echo>({.timeout = 20s});
    CHECK(transports(*newcomer) == std::vector<std::string>{"shared memory"});
    CHECK(service->inside == 1);
    call.cancel();
    CHECK(eventually([&] { return service->saw_cancellation.load(); }));
    CHECK(other.within(20s).echo("") != "");
  }
}

TEST_CASE(
    "a call that would wait for itself is refused also where its service takes requests itself") {
  struct Passing final : EchoService {
    std::string echo(const std::string& text) override {
      return text == "round" ? next->within(20s).echo(text) : thread_name();
    }
    std::optional<Echo::Proxy> next;
  };
  const CallThread thread = GENERATE(CallThread::Own, CallThread::Caller);
  const ServiceOptions options{.thread = thread};
  const auto one = make_entity("one", true), two = make_entity("two", true);
  const auto client = make_entity("client", true);
  const auto first = std::make_shared<Passing>(), second = std::make_shared<Passing>();
  const auto first_id = one->provide<LouderEcho>(first, options);
  const auto second_id = two->provide<LouderEcho>(second, options);
  first->next.emplace(one->connect<Echo>({.provider = second_id}));
  second->next.emplace(two->connect<Echo>({.provider = first_id}));
  auto echo = client->connect<Echo>({.provider = first_id});
  for (auto* each : {&echo, &*first->next, &*second->next}) REQUIRE(runs_on_arrival(*each, thread));
  CHECK_THROWS_WITH(echo.within(20s).echo("round"), Catch::Contains("would wait for itself"));
}

TEST_CASE("a service ends also while a call runs on the thread that takes its requests") {
  const auto server = make_entity("server", true);
  const CallThread thread = GENERATE(CallThread::Own, CallThread::Caller);
  const ServiceOptions options{.thread = thread};
  const auto service = std::make_shared<Placed>();
  const auto id = server->provide<LouderEcho>(service, options);
  const auto client = make_entity("client", true);
  auto echo = client->connect<Echo>();
  REQUIRE(runs_on_arrival(echo, thread));
  auto call = echo.within(60s).async_wait(600'000);
  REQUIRE(eventually([&] { return service->inside == 1; }));
  server->withdraw(id);
  CHECK(service->saw_cancellation);
  CHECK(service->inside == 0);
}

TEST_CASE(
    "a call that does not return is left behind also where its thread had taken its request") {
  struct Hanging final : EchoService {
    std::string echo(const std::string&) override { return thread_name(); }
    bool wait(std::uint32_t) override {
      ++inside;
      hangs.wait(true);
      returned = true;
      return true;
    }
    std::atomic<bool> hangs{true};
    std::atomic<bool> returned{false};
  };
  const Log log;
  const auto server = make_entity("server", true);
  const auto hanging = std::make_shared<Hanging>();
  const auto id = server->provide<LouderEcho>(hanging);
  const auto client = make_entity("client", true);
  auto echo = client->connect<Echo>({.provider = id});
  REQUIRE(runs_on_arrival(echo, CallThread::Own));
  auto call = echo.within(60s).async_wait(0);
  REQUIRE(eventually([&] { return hanging->inside == 1; }));
  server->withdraw(id);
  CHECK(log.count("its thread is left behind") == 1);
  CHECK_THROWS_AS(call.get(), Disconnected);
  const auto next = server->provide<LouderEcho>(std::make_shared<Placed>());
  CHECK(client->connect<Echo>({.provider = next}).within(20s).echo("") == "server");
  hanging->hangs = false;
  hanging->hangs.notify_all();
  CHECK(eventually([&] { return hanging->returned.load(); }));
}

TEST_CASE("a provider that damages the memory ends the call, and is called over DDS from then on") {
  const Log log;
  const auto server = make_entity("server", true);
  const auto service = std::make_shared<EchoService>();
  server->provide<LouderEcho>(service);
  const auto client = make_entity("client", true);
  auto echo = client->connect<Echo>();
  REQUIRE(transports(*client) == std::vector<std::string>{"shared memory"});
  auto pending = echo.within(60s).async_wait(600'000);
  REQUIRE(eventually([&] { return service->inside == 1; }));
  damage_replies();
  CHECK_THROWS_AS(pending.get(), Disconnected);
  CHECK(eventually([&] { return service->saw_cancellation.load(); }));
  CHECK(echo.within(20s).echo("again") == "again");
  CHECK(transports(*client) == std::vector<std::string>{"DDS"});
  CHECK(log.count("has damaged the memory that it shares") > 0);
}

TEST_CASE("damaged memory also ends the call of a thread that takes its answer itself") {
  const Log log;
  const auto server = make_entity("server", true);
  const auto service = std::make_shared<EchoService>();
  server->provide<LouderEcho>(service);
  const auto client = make_entity("client", true);
  auto echo = client->connect<Echo>();
  REQUIRE(transports(*client) == std::vector<std::string>{"shared memory"});
  std::thread caller([&] { CHECK_THROWS_AS(echo.within(60s).wait(600'000), Disconnected); });
  const bool inside = eventually([&] { return service->inside == 1; });
  CHECK(inside);
  if (inside) damage_replies();
  caller.join();
}

TEST_CASE("who calls and waits takes the answer itself") {
  const auto server = make_entity("server", true);
  server->provide<LouderEcho>(std::make_shared<EchoService>());
  const auto client = make_entity("client", true);
  auto echo = client->connect<Echo>();
  const std::uint64_t before = wake_ups_of("skein-replies");
  constexpr int kCalls = 2000;
  for (int i = 0; i < kCalls; ++i) REQUIRE(echo.echo(std::to_string(i)) == std::to_string(i));
  // It looks now and then whether somebody else than those who wait is written to.
  CHECK(wake_ups_of("skein-replies") - before < kCalls / 2);
}

TEST_CASE("who gets the results of asynchronous calls takes the answers itself") {
  const auto server = make_entity("server", true);
  server->provide<LouderEcho>(std::make_shared<EchoService>());
  const auto client = make_entity("client", true);
  auto echo = client->connect<Echo>();
  const std::uint64_t before = wake_ups_of("skein-replies");
  constexpr int kCalls = 2000;
  const std::size_t in_flight = GENERATE(1, 8);
  std::deque<std::pair<Call<std::string>, std::string>> asked;
  const auto get_first = [&] {
    REQUIRE(asked.front().first.get() == asked.front().second);
    asked.pop_front();
  };
  for (int i = 0; i < kCalls; ++i) {
    if (asked.size() == in_flight) get_first();
    const std::string text = std::to_string(i);
    asked.emplace_back(echo.within(20s).async_echo(text), text);
  }
  while (!asked.empty()) get_first();
  CHECK(wake_ups_of("skein-replies") - before < kCalls / 2);
}

TEST_CASE("asynchronous calls with more in flight than their connection holds are all answered") {
  const auto server = make_entity("server", true);
  server->provide<LouderEcho>(std::make_shared<EchoService>());
  const auto client = make_entity("client", true);
  auto echo = client->connect<Echo>();
  for (int round = 0; round < 10; ++round) {
    std::vector<Call<std::string>> asked;
    for (char each = 'a'; each < 'q'; ++each)
      asked.push_back(echo.within(20s).async_echo(std::string(100'000, each)));
    for (char each = 'a'; each < 'q'; ++each)
      CHECK(asked[static_cast<std::size_t>(each - 'a')].get() == std::string(100'000, each));
  }
}

TEST_CASE("each of many that call at once on one connection gets its own answer") {
  const auto server = make_entity("server", true);
  server->provide<LouderEcho>(std::make_shared<EchoService>());
  const auto client = make_entity("client", true);
  auto echo = client->connect<Echo>();
  std::atomic<int> wrong{0};
  std::vector<std::thread> callers;
  for (int caller = 0; caller < 4; ++caller) {
    callers.emplace_back([&, caller] {
      for (int i = 0; i < 200; ++i) {
        const std::string text = std::to_string(caller) + ": " + std::to_string(i);
        if (caller == 0 && i % 3 == 0) {
          auto asked = echo.within(20s).async_echo(text);
          if (asked.get() != text) ++wrong;
        } else if (echo.within(20s).echo(text) != text) {
          ++wrong;
        }
      }
    });
  }
  for (auto& caller : callers) caller.join();
  CHECK(wrong == 0);
}

TEST_CASE("a service that is withdrawn and provided again is found through shared memory again") {
  const auto server = make_entity("server", true);
  const auto client = make_entity("client", true);
  std::optional<Echo::Proxy> echo;
  for (int i = 0; i < 3; ++i) {
    const auto id = server->provide<LouderEcho>(std::make_shared<EchoService>());
    if (!echo) echo.emplace(client->connect<Echo>());
    CHECK(eventually([&] {
      try {
        return echo->echo("hello") == "hello";
      } catch (const Unavailable&) {
        return false;
      } catch (const Disconnected&) {
        return false;
      }
    }));
    CHECK(transports(*client) == std::vector<std::string>{"shared memory"});
    server->withdraw(id);
  }
}
