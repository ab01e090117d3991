
#include "calls/benchmarks.hpp"
#include "calls/flock.hpp"
#include "command/bench/random_turns.hpp"

namespace skein::benchmarks {
namespace {

constexpr const char* kClaim = "peers that start at once until all see all";
constexpr std::uint32_t kSeed = 23;

struct Joiner {
  Configuration configuration;
  Outcome outcome{};

  void join_once(std::size_t peers) {
    if (outcome.absence) return;
    outcome.absence = attempt(configuration.name, [&] {
      outcome.samples.push_back(Flock(configuration, peers).joined_us());
    });
  }
};

Comparison comparison_of(const Joiner& own, const Joiner& raw, std::size_t peers) {
  Comparison comparison{kClaim, own.configuration.name, raw.configuration.name, {{"peers", peers}}};
  comparison.parameters["processes"] = peers;
  fill(comparison, own.outcome, raw.outcome);
  return comparison;
}

}  // namespace

std::vector<Comparison> compare_joins(Configurations& configurations, const JoinPlan& plan) {
  std::vector<std::pair<Joiner, Joiner>> pairs;
  for (const char* vendor : kVendors) {
    pairs.push_back({{configurations.skein_neighbour(vendor, plan.peers)},
                     {configurations.raw_neighbour(vendor, plan.peers)}});
  }
  std::vector<std::function<void()>> turns;
  for (auto& [own, raw] : pairs) {
    turns.push_back([&joiner = own, &plan] { joiner.join_once(plan.peers); });
    turns.push_back([&joiner = raw, &plan] { joiner.join_once(plan.peers); });
  }
  take_turns(plan.rounds, std::move(turns), kSeed, "peers join");
  std::vector<Comparison> comparisons;
  for (const auto& [own, raw] : pairs) comparisons.push_back(comparison_of(own, raw, plan.peers));
  return comparisons;
}

}  // namespace skein::benchmarks
