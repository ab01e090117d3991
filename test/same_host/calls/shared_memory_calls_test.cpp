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

#include "brokerless_discovery/broker.hpp"
#include "core/system/file_descriptor.hpp"
#include "same_host/ring.hpp"
#include "skein/error.hpp"
#include "test/connector/echo_pair.hpp"
#include "test/connector/loopback_entity.hpp"
#include "test/same_host/ring_all_doorbells.hpp"
#include "test/tools/eventually.hpp"
#include "test/tools/log.hpp"

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

/// Does not return from wait() until it is told to.
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

/// Calls until they run on the thread that takes them.
bool runs_on_arrival(Echo::Proxy& echo) {
  return eventually([&] {
    constexpr int kCalls = 60;
    const std::uint64_t before = wake_ups_of("skein-requests");
    const auto begin = std::chrono::steady_clock::now();
    for (int i = 0; i < kCalls; ++i) echo.within(20s).echo("");
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
    write(replies.caller_sleeps, std::uint32_t{0});
    same_host::futex_wake(replies.caller_sleeps);
  }
  REQUIRE(damaged > 0);
  ring_all_doorbells();
}

template <class Implementation = EchoService>
struct Pair : EchoPair<Implementation> {
  explicit Pair(const ServiceOptions& options = {}, bool by_server = true, bool by_client = true)
      : EchoPair<Implementation>(make_entity("server", by_server), make_entity("client", by_client),
                                 options) {}
};

/// Its calls run where they arrive.
template <class Implementation>
struct OnArrival {
  bool comes_to_be() { return runs_on_arrival(*pair.echo); }

  const CallThread thread = GENERATE(CallThread::Own, CallThread::Caller);
  Pair<Implementation> pair{{.thread = thread}};
};

void check_transport(Entity& client, const std::string& transport, const std::string& not_faster) {
  const auto connections = client.connector().connections();
  REQUIRE(connections.size() == 1);
  CHECK(connections.front().transport == transport);
  CHECK(connections.front().not_faster == not_faster);
}

}  // namespace

TEST_CASE("calls go through shared memory where both sides are told to, and over DDS otherwise") {
  const bool by_server = GENERATE(false, true);
  const bool by_client = GENERATE(false, true);
  Pair<> pair({}, by_server, by_client);
  CHECK(pair.echo->echo("hello") == "hello");
  check_transport(*pair.client, by_server && by_client ? "shared memory" : "DDS",
                  !by_client   ? "the caller does not use shared memory for calls"
                  : !by_server ? "the provider does not use shared memory for calls"
                               : "");
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
  CHECK(brokerless_discovery::takes_loans(*found.front()) == by_server);
}

TEST_CASE("a provider that only says that it is called through shared memory is called over DDS",
          "[R29]") {
  Pair<> pair({.attributes = {{"skein:shared_memory_calls", "true"}}}, false);
  CHECK(pair.echo->echo("hello") == "hello");
  check_transport(*pair.client, "DDS", "no connection through shared memory: nobody offers one");
}

TEST_CASE_METHOD(OnArrival<Placed>, "a service's own thread runs all its calls from elsewhere") {
  CHECK(pair.echo->echo("") == "server");
  REQUIRE(comes_to_be());
  CHECK(pair.echo->echo("") == "server");
  auto stream = pair.echo->burst(1);
  const auto name = stream.next();
  REQUIRE(name);
  CHECK(std::string(name->begin(), name->end()) == "server");
}

TEST_CASE_METHOD(OnArrival<Placed>,
                 "a call that takes long on the thread that takes it holds up no other service") {
  const auto quick_id =
      pair.server->provide<LouderEcho>(std::make_shared<Placed>(), {.thread = thread});
  auto quick_echo = pair.client->connect<Echo>({.provider = quick_id});
  REQUIRE(comes_to_be());
  REQUIRE(runs_on_arrival(quick_echo));
  auto call = pair.echo->within(60s).async_wait(600'000);
  REQUIRE(eventually([&] { return pair.service->inside == 1; }));
  CHECK(runs_on_arrival(quick_echo));
  CHECK(pair.client->connect<Echo>({.provider = quick_id}).within(20s).echo("") != "");
  CHECK(pair.service->inside == 1);
  CHECK(transports(*pair.client) == std::vector<std::string>(2, "shared memory"));
}

TEST_CASE_METHOD(
    OnArrival<Placed>,
    "a call that takes long on the thread that takes it hears of its end, and newcomers get in") {
  for (int i = 0; i < 3; ++i) {
    REQUIRE(comes_to_be());
    pair.service->saw_cancellation = false;
    auto call = pair.echo->within(60s).async_wait(600'000);
    REQUIRE(eventually([&] { return pair.service->inside == 1; }));
    const auto newcomer = make_entity("newcomer");
    auto other = newcomer->connect<Echo>({.timeout = 20s});
    CHECK(transports(*newcomer) == std::vector<std::string>{"shared memory"});
    CHECK(pair.service->inside == 1);
    call.cancel();
    CHECK(eventually([&] { return pair.service->saw_cancellation.load(); }));
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
  const auto one = make_entity("one"), two = make_entity("two");
  const auto client = make_entity("client");
  const auto first = std::make_shared<Passing>(), second = std::make_shared<Passing>();
  const auto first_id = one->provide<LouderEcho>(first, options);
  const auto second_id = two->provide<LouderEcho>(second, options);
  first->next.emplace(one->connect<Echo>({.provider = second_id}));
  second->next.emplace(two->connect<Echo>({.provider = first_id}));
  auto echo = client->connect<Echo>({.provider = first_id});
  for (auto* each : {&echo, &*first->next, &*second->next}) REQUIRE(runs_on_arrival(*each));
  CHECK_THROWS_WITH(echo.within(20s).echo("round"), Catch::Contains("would wait for itself"));
}

TEST_CASE_METHOD(OnArrival<Placed>,
                 "a service ends also while a call runs on the thread that takes its requests") {
  REQUIRE(comes_to_be());
  auto call = pair.echo->within(60s).async_wait(600'000);
  REQUIRE(eventually([&] { return pair.service->inside == 1; }));
  pair.server->withdraw(pair.id);
  CHECK(pair.service->saw_cancellation);
  CHECK(pair.service->inside == 0);
}

TEST_CASE(
    "a call that does not return is left behind also where its thread had taken its request") {
  const Log log;
  Pair<Hanging> pair;
  REQUIRE(runs_on_arrival(*pair.echo));
  auto call = pair.echo->within(60s).async_wait(0);
  REQUIRE(eventually([&] { return pair.service->inside == 1; }));
  pair.server->withdraw(pair.id);
  CHECK(log.count("its thread is left behind") == 1);
  CHECK_THROWS_AS(call.get(), Disconnected);
  const auto next = pair.server->provide<LouderEcho>(std::make_shared<Placed>());
  CHECK(pair.client->connect<Echo>({.provider = next}).within(20s).echo("") == "server");
  pair.service->hangs = false;
  pair.service->hangs.notify_all();
  CHECK(eventually([&] { return pair.service->returned.load(); }));
}

TEST_CASE("a provider that damages the memory ends the call, and is called over DDS from then on") {
  const Log log;
  Pair<> pair;
  REQUIRE(transports(*pair.client) == std::vector<std::string>{"shared memory"});
  std::thread caller;
  bool disconnected = false;  // Catch's macros are for one thread
  std::optional<Call<bool>> pending;
  const bool waits = GENERATE(false, true);  // and takes its answer itself
  if (waits) {
    caller = std::thread([&] {
      try {
        pair.echo->within(60s).wait(600'000);
      } catch (const Disconnected&) {
        disconnected = true;
      }
    });
  } else {
    pending.emplace(pair.echo->within(60s).async_wait(600'000));
  }
  const bool inside = eventually([&] { return pair.service->inside == 1; });
  CHECK(inside);
  if (inside) damage_replies();
  if (waits) {
    caller.join();
    CHECK(disconnected);
  } else {
    CHECK_THROWS_AS(pending->get(), Disconnected);
  }
  CHECK(eventually([&] { return pair.service->saw_cancellation.load(); }));
  CHECK(pair.echo->within(20s).echo("again") == "again");
  CHECK(transports(*pair.client) == std::vector<std::string>{"DDS"});
  CHECK(log.count("has damaged the memory that it shares") > 0);
}

TEST_CASE("who waits for answers, or gets the results of asynchronous calls, takes them itself") {
  Pair<> pair;
  const std::uint64_t before = wake_ups_of("skein-replies");
  constexpr int kCalls = 2000;
  const std::size_t in_flight = GENERATE(0, 1, 8);  // none: the caller waits
  std::deque<std::pair<Call<std::string>, std::string>> asked;
  const auto get_first = [&] {
    REQUIRE(asked.front().first.get() == asked.front().second);
    asked.pop_front();
  };
  for (int i = 0; i < kCalls; ++i) {
    const std::string text = std::to_string(i);
    if (in_flight == 0) {
      REQUIRE(pair.echo->echo(text) == text);
      continue;
    }
    if (asked.size() == in_flight) get_first();
    asked.emplace_back(pair.echo->within(20s).async_echo(text), text);
  }
  while (!asked.empty()) get_first();
  // It looks now and then whether somebody else than those who wait is written to.
  CHECK(wake_ups_of("skein-replies") - before < kCalls / 2);
}

TEST_CASE("asynchronous calls with more in flight than their connection holds are all answered") {
  Pair<> pair;
  for (int round = 0; round < 10; ++round) {
    std::vector<Call<std::string>> asked;
    for (char each = 'a'; each < 'q'; ++each)
      asked.push_back(pair.echo->within(20s).async_echo(std::string(100'000, each)));
    for (char each = 'a'; each < 'q'; ++each)
      CHECK(asked[static_cast<std::size_t>(each - 'a')].get() == std::string(100'000, each));
  }
}

TEST_CASE("a service that is withdrawn and provided again is found through shared memory again") {
  const auto server = make_entity("server");
  const auto client = make_entity("client");
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
