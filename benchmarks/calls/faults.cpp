#include <algorithm>
#include <csignal>
#include <cstdio>
#include <map>
#include <thread>

#include "calls/benchmarks.hpp"
#include "command/bench/random_turns.hpp"
#include "harness/goals.hpp"
#include "harness/private_network.hpp"

namespace skein::benchmarks {
namespace {

using namespace std::chrono_literals;

constexpr const char* kOverdueClaim = "deadline to its call's end";
constexpr const char* kAnsweredClaim = "a fault's end to an answer";
constexpr const char* kCompleteClaim = "a fault's end to a complete registry";
constexpr const char* kStopped = "provider stopped beyond its lease";
constexpr const char* kKilled = "provider killed, from its new process's start";
constexpr const char* kCut = "network cut";
constexpr std::uint32_t kSeed = 17;
/// The lease is 1 s.
constexpr auto kStop = 1500ms;

Configuration survivors(Configurations& configurations, const std::string& server,
                        const std::string& client, const std::optional<Place>& server_place = {},
                        const std::optional<Place>& client_place = {}) {
  auto made = configurations.skein(server, client, 1, server_place, client_place);
  made.server.push_back("--survives");
  made.client.push_back("--survives");
  return made;
}

/// A pair of peers, and how long each thing took after each fault.
struct Survivors {
  Configuration configuration;
  std::map<std::pair<const char*, const char*>, std::vector<double>> samples{};  // by claim, where
  Absence absence{};
  std::optional<Running> running{};

  void start(int server_network = -1, int client_network = -1) {
    running.emplace(configuration, server_network, client_network);
    watch();
    for (Child* peer : {&running->client, &running->client, &*running->server}) peer->receive();
  }

  /// From now on the client calls without rest until it is answered, and both wait until they know
  /// all.
  void watch() {
    running->client.send("answered");
    running->client.send("complete");
    running->server->send("complete");
  }

  void healed(const char* where, Instant fault_ended) {
    const auto time_of = [&](Child& peer) {
      const std::string answer = peer.receive();
      return between_us(fault_ended, answer.substr(answer.find(' ') + 1));
    };
    add(kAnsweredClaim, where, time_of(running->client));
    add(kCompleteClaim, where, std::max(time_of(running->client), time_of(*running->server)));
  }

  void add(const char* claim, const char* where, double time_us) {
    samples[{claim, where}].push_back(time_us);
  }
};

void unless_absent(Survivors& pair, const std::function<void()>& action) {
  if (!pair.absence) pair.absence = attempt(pair.configuration.name, action);
  if (pair.absence) pair.running.reset();
}

void stop_and_kill(Survivors& pair, std::size_t calls) {
  pair.start();
  Running& running = *pair.running;
  const Instant stopped = running.server->signal(SIGSTOP);
  for (const double late_us : running.times("overdue " + std::to_string(calls)))
    pair.add(kOverdueClaim, kStopped, late_us);
  std::this_thread::sleep_until(stopped + kStop);
  pair.watch();
  const Instant resumed = running.server->signal(SIGCONT);
  pair.healed(kStopped, resumed);

  running.server->kill();
  running.server.emplace(pair.configuration.server);
  pair.watch();
  running.server->receive();
  pair.healed(kKilled, running.server->started());
  pair.running.reset();
}

void cut_network(std::vector<Survivors>& pairs, TwoHosts& hosts, std::chrono::milliseconds cut) {
  for (Survivors& pair : pairs)
    unless_absent(pair, [&] { pair.start(hosts.first().network, hosts.second().network); });
  hosts.cut();
  std::this_thread::sleep_for(cut);
  for (Survivors& pair : pairs) unless_absent(pair, [&] { pair.watch(); });
  hosts.heal();
  const Instant healed = std::chrono::steady_clock::now();
  for (Survivors& pair : pairs) unless_absent(pair, [&] { pair.healed(kCut, healed); });
  for (Survivors& pair : pairs) pair.running.reset();
}

void add_comparisons(std::vector<Comparison>& all, const std::vector<Survivors>& pairs,
                     const char* claim, const char* where, const char* limit, double limit_us) {
  for (const Survivors& pair : pairs) {
    const auto measured = pair.samples.find({claim, where});
    const auto samples = measured == pair.samples.end() ? std::vector<double>() : measured->second;
    Comparison& comparison =
        all.emplace_back(Comparison{claim, pair.configuration.name, limit, {{"where", where}}});
    fill(comparison, {samples, pair.absence}, {{limit_us}});
  }
}

void add_healing(std::vector<Comparison>& all, const std::vector<Survivors>& pairs,
                 const char* where) {
  add_comparisons(all, pairs, kAnsweredClaim, where, "limit 2 s", kHealedUs);
  add_comparisons(all, pairs, kCompleteClaim, where, "limit 2 s", kHealedUs);
}

}  // namespace

std::vector<Comparison> compare_faults_on_one_host(Configurations& configurations,
                                                   const FaultPlan& plan) {
  std::vector<Survivors> pairs;
  for (const auto& [server, client] : vendor_pairs())
    pairs.push_back({survivors(configurations, server, client)});
  std::vector<std::function<void()>> turns;
  for (Survivors& pair : pairs)
    turns.push_back([&] { unless_absent(pair, [&] { stop_and_kill(pair, plan.calls); }); });
  take_turns(plan.stops, std::move(turns), kSeed, "providers stopped and killed");
  std::vector<Comparison> comparisons;
  add_comparisons(comparisons, pairs, kOverdueClaim, kStopped, "limit 50 ms", kOverdueUs);
  add_healing(comparisons, pairs, kStopped);
  add_healing(comparisons, pairs, kKilled);
  return comparisons;
}

std::vector<Comparison> compare_faults_across_hosts(Configurations& configurations,
                                                    const FaultPlan& plan) {
  std::optional<TwoHosts> hosts;
  const Absence absence = attempt("two hosts", [&] { hosts.emplace(); });
  const Place first = hosts ? Place{hosts->first().address, hosts->second().address} : Place{};
  const Place second{first.peer, first.interface};
  std::vector<Survivors> pairs;
  for (const auto& [server, client] : vendor_pairs()) {
    pairs.push_back({survivors(configurations, server, client, first, second)});
    pairs.back().absence = absence;
  }
  for (std::size_t round = 0; hosts && round < plan.cuts; ++round) {
    std::fprintf(stderr, "\rnetwork cut: round %zu of %zu ", round + 1, plan.cuts);
    cut_network(pairs, *hosts, plan.cut);
  }
  std::fputc('\n', stderr);
  std::vector<Comparison> comparisons;
  add_healing(comparisons, pairs, kCut);
  return comparisons;
}

}  // namespace skein::benchmarks
