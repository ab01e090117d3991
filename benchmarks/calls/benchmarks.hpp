#pragma once

#include <vector>

#include "calls/configuration.hpp"
#include "harness/comparison.hpp"

/// The first benchmarks: what a call costs, how long the first one takes, and how soon a caller knows
/// that its provider is dead.
namespace skein::benchmarks {

struct CallPlan {
  struct Size {
    std::size_t size_bytes;
    std::size_t calls_per_turn;
  };
  std::vector<Size> sizes;
  std::size_t rounds;
};

/// Calls through Skein, raw calls and a Unix socket, all processes alive and taking turns.
/// One comparison for each pair of vendors, size and rival.
std::vector<Comparison> compare_calls(Configurations& configurations, const CallPlan& plan);

/// Fresh pairs of processes; the provider is up, the client's process begins.
std::vector<Comparison> compare_cold_starts(Configurations& configurations, std::size_t starts);

/// SIGKILL to a provider with a call pending: until the caller has Disconnected, and until the
/// description has gone.
std::vector<Comparison> compare_deaths_on_one_host(Configurations& configurations, std::size_t kills);
std::vector<Comparison> compare_deaths_across_hosts(Configurations& configurations, std::size_t kills);

}  // namespace skein::benchmarks
