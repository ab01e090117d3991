#include <algorithm>
#include <catch2/catch.hpp>
#include <csignal>
#include <filesystem>
#include <fstream>

#include "test/connector/echo_service.hpp"
#include "test/faults/processes.hpp"
#include "test/tools/invariant.hpp"

using namespace skein;
using namespace skein::test;
using namespace std::chrono_literals;
using ::test::LouderEcho;

namespace {

/// So long that whatever is noticed in a test is noticed by other means.
const std::vector<std::string> kOverMemory{"lease=60000", "shared_memory_calls"};
const std::vector<std::string> kOverDds{"lease=60000"};

std::shared_ptr<dds::Vendor> vendor(const char* name) {
  try {
    return dds::load_vendor(name);
  } catch (const Unavailable& error) {
    std::fprintf(stderr, "skipped: %s\n", error.what());
    std::_Exit(77);
  }
}

std::unique_ptr<Entity> make_entity(const std::string& name, const char* vendor_name) {
  EntityOptions options;
  options.name = name;
  options.system = "uav-1";
  options.vendor = vendor(vendor_name);
  options.domain = 17;
  options.lease = 60s;
  options.shared_memory_calls = true;
  return std::make_unique<Entity>(std::move(options));
}

/// Of the connections of a client that has one provider.
std::string transport(Entity& client) {
  const auto connections = client.connector().connections();
  return connections.size() == 1 ? connections.front().transport
                                 : std::to_string(connections.size()) + " connections";
}

/// A provider in a process of its own, and a client of it on the other vendor.
struct Pair {
  Pair()
      : client(make_entity("client", "cyclonedds")),
        echo(client->connect<LouderEcho>({.timeout = 20s})) {
    REQUIRE(transport(*client) == "shared memory");
  }
  bool inside(int calls) {
    return eventually([&] { return provider.ask("inside") == "inside " + std::to_string(calls); });
  }

  ChildProcess provider = start_provider("provider", *vendor("fastdds"), kOverMemory);
  const std::unique_ptr<Entity> client;
  LouderEcho::Proxy echo;
};

/// Answers `shout` with much, once it may.
struct GatedEcho : EchoService {
  std::string shout(const std::string&) override {
    open.wait(false);
    return std::string(100'000, 'x');
  }
  std::atomic<bool> open{false};
};

/// What a process has by the kernel's account: it grows with each client, and shrinks again.
struct Holding {
  std::ptrdiff_t threads = 0;
  std::ptrdiff_t descriptors = 0;
  std::ptrdiff_t rings = 0;
  bool operator==(const Holding&) const = default;
};

Holding holding_of(const ChildProcess& process) {
  const std::string place = "/proc/" + std::to_string(process.pid());
  const auto entries = [&](const char* folder) {
    return std::distance(std::filesystem::directory_iterator(place + folder),
                         std::filesystem::directory_iterator());
  };
  Holding holding{entries("/task"), entries("/fd")};
  std::ifstream maps(place + "/maps");
  for (std::string line; std::getline(maps, line);) {
    holding.rings += line.find("memfd:skein") != line.npos;
  }
  return holding;
}

}  // namespace

TEST_CASE_METHOD(Pair,
                 "a process calls another one through shared memory, whichever vendors they have") {
  for (int i = 0; i < 1000; ++i) {
    const auto text = std::to_string(i);
    INVARIANT(echo.within(20s).echo(text) == text);
  }
  std::int32_t remainder = 0;
  CHECK(echo.within(20s).divide(17, 5, remainder) == 3);
  CHECK(remainder == 2);
  CHECK_THROWS_AS(echo.within(20s).divide(17, 0, remainder), ::test::DivisionByZero);
  for (const std::size_t size : {100, 200'000, 3'000'000}) {
    const std::vector<std::uint8_t> content(size, static_cast<std::uint8_t>(size));
    INVARIANT(echo.within(20s).echo_octets(content) == content);
  }
  std::vector<Call<std::string>> calls;
  for (int i = 0; i < 200; ++i) calls.push_back(echo.within(20s).async_echo(std::to_string(i)));
  for (int i = 0; i < 200; ++i)
    INVARIANT(calls[static_cast<std::size_t>(i)].get() == std::to_string(i));
  CHECK(transport(*client) == "shared memory");
}

TEST_CASE_METHOD(Pair,
                 "a provider that is killed ends its calls as Disconnected; the next one goes to "
                 "another provider, over DDS where that has no more") {
  const bool memory = GENERATE(true, false);
  auto call = echo.within(10min).async_wait(600'000);
  REQUIRE(inside(1));
  provider.signal(SIGKILL);
  CHECK_THROWS_AS(call.get(), Disconnected);
  auto next = start_provider("next", *vendor("fastdds"), memory ? kOverMemory : kOverDds);
  CHECK(eventually([&] {
    try {
      return echo.within(20s).echo("again") == "again";
    } catch (const Unavailable&) {  // not found yet
      return false;
    }
  }));
  CHECK(transport(*client) == (memory ? "shared memory" : "DDS"));
  CHECK(next.ask("calls") == "calls 1");
}

TEST_CASE(
    "of a client that is killed in a call, a stream or while it pours, its provider keeps "
    "nothing") {
  auto provider = start_provider("provider", *vendor("fastdds"), kOverMemory);
  const auto kill_one = [&](const std::vector<const char*>& does) {
    auto client = start_client("client", *vendor("cyclonedds"), kOverMemory);
    REQUIRE(holding_of(provider).rings == 1);
    for (const char* command : does) {
      const std::string answer = client.ask(command);
      CHECK_FALSE(answer.starts_with("error"));
    }
    client.signal(SIGKILL);
    CHECK(eventually([&] { return provider.ask("inside") == "inside 0"; }));
    CHECK(eventually([&] { return holding_of(provider).rings == 0; }));
  };
  kill_one({"echo 1 first"});  // starts the threads that stay
  Holding before;
  // The vendor's part is over with the client's description.
  REQUIRE(eventually([&] { return std::exchange(before, holding_of(provider)) == before; }));
  kill_one({"wait"});
  kill_one({"listen"});
  kill_one({"pour 1000"});
  kill_one({"echo 10 hello", "octets 3000000 large", "listen"});
  CHECK(eventually([&] { return holding_of(provider) == before; }));
}

TEST_CASE("a client that is stopped with its memory full of replies holds up nobody else") {
  const auto server = make_entity("server", "fastdds");
  const auto gated = std::make_shared<GatedEcho>();
  server->provide<LouderEcho>(gated);
  auto deaf = start_client("deaf", *vendor("cyclonedds"), kOverMemory);
  auto good = start_client("good", *vendor("cyclonedds"), kOverMemory);
  deaf.send("pour 100");
  deaf.expect("poured");
  deaf.signal(SIGSTOP);
  gated->open = true;
  gated->open.notify_all();
  good.send("echo 20 x");
  good.expect("echoed");
  deaf.signal(SIGCONT);
  deaf.send("echo 1 x");
  deaf.expect("echoed");
}
