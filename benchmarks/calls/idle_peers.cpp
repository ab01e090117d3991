#include <algorithm>
#include <array>
#include <cstdio>
#include <thread>

#include "calls/benchmarks.hpp"
#include "calls/flock.hpp"
#include "command/bench/random_turns.hpp"
#include "harness/loopback_traffic.hpp"

namespace skein::benchmarks {
namespace {

constexpr std::uint32_t kSeed = 29;
/// For what discovery still repeats when all have found all.
constexpr std::chrono::milliseconds kSettling{2000};

/// Of one peer in a second, by window.
struct Cost {
  std::vector<double> octets{};
  std::vector<double> packets{};
  std::vector<double> cpu_us{};
};

struct Figure {
  const char* claim;
  const char* unit;
  std::vector<double> Cost::*samples;
};
constexpr std::array<Figure, 3> kFigures{{
    {"octets that an idle peer sends, per second", "octets", &Cost::octets},
    {"packets that an idle peer sends, per second", "packets", &Cost::packets},
    {"processor time of an idle peer, per second", "us", &Cost::cpu_us},
}};

/// What discovery and leases cost grows with the number's square. On two cores 50 peers take half
/// of the processor while they are idle, and 100 did not find each other within a minute, raw ones
/// neither.
constexpr std::size_t kMaxOnACore = 25;

void refuse_too_many(std::size_t peers) {
  const std::size_t cores = std::max(1u, std::thread::hardware_concurrency());
  if (peers <= kMaxOnACore * cores) return;
  throw Skipped(std::to_string(peers) + " peers are too many for " + std::to_string(cores) +
                " cores: at most " + std::to_string(kMaxOnACore) + " a core find each other");
}

struct Idler {
  Configuration configuration;
  Cost cost{};
  Absence absence{};

  void rest(std::size_t peers, const IdlePlan& plan) {
    absence = attempt(configuration.name, [&] {
      refuse_too_many(peers);
      Flock flock(configuration, peers);
      std::this_thread::sleep_for(std::min(kSettling, plan.window * 2));
      for (std::size_t i = 0; i < plan.windows; ++i)
        watch(flock, static_cast<double>(peers), plan.window);
    });
  }

  Outcome outcome_of(std::vector<double> Cost::*samples) const { return {cost.*samples, absence}; }

 private:
  void watch(Flock& flock, double peers, std::chrono::milliseconds window) {
    const double cpu_us = flock.cpu_us();
    const LoopbackTraffic before = loopback_traffic();
    const auto begin = std::chrono::steady_clock::now();
    std::this_thread::sleep_for(window);
    const LoopbackTraffic after = loopback_traffic();
    const std::chrono::duration<double> took = std::chrono::steady_clock::now() - begin;
    const double peer_seconds = peers * took.count();
    cost.octets.push_back(static_cast<double>(after.octets - before.octets) / peer_seconds);
    cost.packets.push_back(static_cast<double>(after.packets - before.packets) / peer_seconds);
    cost.cpu_us.push_back((flock.cpu_us() - cpu_us) / peer_seconds);
  }
};

void compare(std::vector<Comparison>& comparisons, const Idler& own, const Idler& rival,
             std::size_t peers) {
  for (const Figure& figure : kFigures) {
    Comparison comparison{figure.claim,
                          own.configuration.name,
                          rival.configuration.name,
                          {{"peers", peers}, {"processes", peers}}};
    comparison.unit = figure.unit;
    fill(comparison, own.outcome_of(figure.samples), rival.outcome_of(figure.samples));
    comparisons.push_back(std::move(comparison));
  }
}

}  // namespace

std::vector<Comparison> compare_idle_peers(Configurations& configurations, const IdlePlan& plan) {
  std::vector<Comparison> comparisons;
  for (const std::size_t peers : plan.peers) {
    for (const char* vendor : kVendors) {
      std::fprintf(stderr, "idle: %zu peers on %s\n", peers, vendor);
      Idler own{configurations.skein_neighbour(vendor, peers)};
      Idler raw{configurations.raw_neighbour(vendor, peers)};
      Idler participants{configurations.bystander(vendor, peers)};
      std::vector<std::function<void()>> turns;
      for (Idler* const idler : {&own, &raw, &participants}) {
        turns.push_back([&, idler] { idler->rest(peers, plan); });
      }
      take_turns(1, std::move(turns), kSeed);
      compare(comparisons, own, raw, peers);
      compare(comparisons, own, participants, peers);
    }
  }
  return comparisons;
}

}  // namespace skein::benchmarks
