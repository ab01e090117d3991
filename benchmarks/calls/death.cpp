#include <map>
#include <random>
#include <span>
#include <sstream>
#include <thread>

#include "calls/benchmarks.hpp"
#include "command/bench/random_turns.hpp"
#include "harness/goals.hpp"
#include "harness/private_network.hpp"

namespace skein::benchmarks {
namespace {

constexpr const char* kToldClaim = "provider killed to caller told";
constexpr const char* kGoneClaim = "provider killed to its description gone";
constexpr std::uint32_t kSeed = 13;
/// What EntityOptions has by default.
constexpr double kLeaseUs = 1'000'000;

struct Limit {
  std::string name;
  double time_us;
};

struct Victim {
  Configuration configuration;
  std::vector<double> told_us{};
  std::vector<double> gone_us{};
  Absence absence{};

  void kill_once(const TwoHosts* hosts, std::mt19937& random) {
    if (absence) return;
    absence = attempt(configuration.name, [&] { kill_provider(hosts, random); });
  }

 private:
  void kill_provider(const TwoHosts* hosts, std::mt19937& random) {
    Running running(configuration, hosts ? hosts->first().network : -1,
                    hosts ? hosts->second().network : -1);
    running.client.send("hold");
    running.client.receive();
    running.client.send("told");
    // At a random phase of heartbeats and announcements, with the caller already waiting.
    std::this_thread::sleep_for(std::chrono::milliseconds(100 + random() % 400));
    const Instant killed = running.server->kill();
    std::istringstream words(running.client.receive());
    std::string title;
    long long told_ns = 0, gone_ns = 0;
    words >> title >> told_ns >> gone_ns;
    const auto killed_ns = std::chrono::nanoseconds(killed.time_since_epoch()).count();
    told_us.push_back(static_cast<double>(told_ns - killed_ns) / 1000);
    gone_us.push_back(static_cast<double>(gone_ns - killed_ns) / 1000);
  }
};

Comparison death_comparison(const char* claim, const Victim& victim,
                            const std::vector<double>& samples, const Limit& limit,
                            const std::string& where) {
  Comparison comparison{claim, victim.configuration.name, limit.name, {{"where", where}}};
  fill(comparison, {samples, victim.absence}, {{limit.time_us}});
  return comparison;
}

void kill_all(std::vector<Victim>& victims, std::size_t kills, const TwoHosts* hosts,
              const std::string& where) {
  std::mt19937 random(kSeed);
  std::vector<std::function<void()>> turns;
  for (Victim& victim : victims) {
    turns.push_back([&] { victim.kill_once(hosts, random); });
  }
  take_turns(kills, std::move(turns), kSeed, "providers killed, " + where);
}

std::vector<Comparison> compare_deaths(std::span<const Victim> victims, const Limit& limit,
                                       const std::string& where) {
  std::vector<Comparison> comparisons;
  for (const Victim& victim : victims) {
    comparisons.push_back(death_comparison(kToldClaim, victim, victim.told_us, limit, where));
    comparisons.push_back(death_comparison(kGoneClaim, victim, victim.gone_us, limit, where));
  }
  return comparisons;
}

}  // namespace

std::vector<Comparison> compare_deaths_on_one_host(Configurations& configurations,
                                                   std::size_t kills) {
  const char* const where = "one host";
  std::vector<Victim> victims;
  for (const auto& [server, client] : vendor_pairs()) {
    victims.push_back({configurations.skein(server, client, 2)});
  }
  using Memory = Configurations::SharedMemory;
  const auto same_host = [&] { return configurations.skein_same_host(Memory::Sleeping, 2); };
  victims.push_back({same_host()});
  std::uint64_t resident = 0;
  const Absence unknown = attempt("the provider's size", [&] {
    Running running(same_host());
    running.server->send("resident");
    resident = std::stoull(running.server->receive());
  });
  victims.push_back({configurations.unix_socket(resident)});
  victims.back().absence = unknown;
  kill_all(victims, kills, nullptr, where);
  const Victim bare = std::move(victims.back());
  victims.pop_back();
  auto comparisons = compare_deaths(victims, {"limit 20 ms", kToldOnOneHostUs}, where);
  const Victim& shared = victims.back();
  Comparison& beside = comparisons.emplace_back(Comparison{kHungUpClaim,
                                                           shared.configuration.name,
                                                           "a bare process as large",
                                                           {{"resident_octets", resident}}});
  fill(beside, {shared.told_us, shared.absence}, {bare.told_us, bare.absence});
  return comparisons;
}

std::vector<Comparison> compare_deaths_across_hosts(Configurations& configurations,
                                                    std::size_t kills) {
  const char* const where = "across two hosts";
  std::optional<TwoHosts> hosts;
  const Absence absence = attempt("two hosts", [&] { hosts.emplace(); });
  const Place first = hosts ? Place{hosts->first().address, hosts->second().address} : Place{};
  const Place second{first.peer, first.interface};
  std::vector<Victim> victims;
  for (const auto& [server, client] : vendor_pairs()) {
    victims.push_back({configurations.skein(server, client, 2, first, second)});
    victims.back().absence = absence;
  }
  kill_all(victims, kills, hosts ? &*hosts : nullptr, where);
  return compare_deaths(victims, {"limit lease + 50 ms", kLeaseUs + kToldBeyondLeaseUs}, where);
}

}  // namespace skein::benchmarks
