#include <algorithm>
#include <catch2/catch.hpp>
#include <cstdio>
#include <random>

#include "test/faults/processes.hpp"
#include "test/tools/invariant.hpp"

using namespace skein::test;
using namespace std::chrono_literals;

namespace {

std::uint64_t number_from(const char* variable, std::uint64_t otherwise) {
  const char* text = std::getenv(variable);
  return text ? std::stoull(text) : otherwise;
}

/// Which of two processes starts first, and how much earlier.
struct Start {
  bool server_first = true;
  std::chrono::milliseconds offset{};
};

/// From the client's main() to its first reply, in ms.
int run_pair(const Start& start) {
  const auto server = [] {
    auto child = start_peer("server", *Pairing::get().server);
    child.send("provide");
    return child;
  };
  const auto client = [] {
    auto child = start_peer("client", *Pairing::get().client);
    child.send("connect\necho 1 first");
    return child;
  };
  std::optional<ChildProcess> serving, calling;
  if (start.server_first) serving.emplace(server());
  if (!start.server_first) calling.emplace(client());
  std::this_thread::sleep_for(start.offset);
  if (!serving) serving.emplace(server());
  if (!calling) calling.emplace(client());

  serving->expect("provided");
  calling->expect("connected", 30s);
  const int time_ms = std::stoi(calling->expect("echoed", 30s));
  const std::string executed = serving->ask("calls");
  INVARIANT(executed == "calls 1");
  CHECK(calling->finish() == 0);
  CHECK(serving->finish() == 0);
  return time_ms;
}

}  // namespace

TEST_CASE("no first call between fresh processes is lost, and each is executed exactly once") {
  const std::uint64_t pairs = number_from("SKEIN_FIRST_CALL_PAIRS", 25);
  const std::uint64_t seed = number_from("SKEIN_SEED", std::random_device{}());
  std::mt19937_64 random(seed);
  std::vector<int> times;
  for (std::uint64_t i = 0; i < pairs; ++i) {
    const Start start{(random() & 1) != 0, std::chrono::milliseconds(random() % 250)};
    INFO("SKEIN_SEED=" << seed << ", pair " << i << ": "
                       << (start.server_first ? "server" : "client") << " first, the other "
                       << start.offset.count() << " ms later");
    times.push_back(run_pair(start));
  }
  std::sort(times.begin(), times.end());
  REQUIRE(times.size() == pairs);
  std::printf(
      "%s server, %s client: %zu of %zu first calls answered; start to first reply %d ms in the "
      "middle, %d ms at most; SKEIN_SEED=%llu\n",
      Pairing::get().server->name().c_str(), Pairing::get().client->name().c_str(), times.size(),
      static_cast<std::size_t>(pairs), times[times.size() / 2], times.back(),
      static_cast<unsigned long long>(seed));
}
