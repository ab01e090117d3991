#include <map>

#include "calls/benchmarks.hpp"
#include "command/bench/random_turns.hpp"

namespace skein::benchmarks {
namespace {

constexpr const char* kClaim = "process start to first reply";
constexpr std::uint32_t kSeed = 11;

struct Starter {
  Configuration configuration;
  Outcome outcome{};

  void start_once() {
    if (outcome.absence) return;
    outcome.absence = attempt(configuration.name, [&] {
      outcome.samples.push_back(Running(configuration).first_reply_us);
    });
  }
};

}  // namespace

std::vector<Comparison> compare_cold_starts(Configurations& configurations, std::size_t starts) {
  std::map<std::string, Starter> starters;
  std::vector<std::function<void()>> turns;
  for (const auto& [server, client] : vendor_pairs()) {
    for (auto& made : {configurations.skein(server, client), configurations.raw(server, client)}) {
      Starter& starter = starters.emplace(made.name, Starter{made}).first->second;
      turns.push_back([&starter] { starter.start_once(); });
    }
  }
  take_turns(starts, std::move(turns), kSeed, "cold starts");

  std::vector<Comparison> comparisons;
  for (const auto& [server, client] : vendor_pairs()) {
    const std::string pair = pair_name(server, client);
    const Starter& own = starters.at("skein " + pair);
    const Starter& raw = starters.at("raw " + pair);
    Comparison comparison{kClaim, own.configuration.name, raw.configuration.name};
    comparison.parameters["provider"] = "already up";
    fill(comparison, own.outcome, raw.outcome);
    comparisons.push_back(std::move(comparison));
  }
  return comparisons;
}

}  // namespace skein::benchmarks
