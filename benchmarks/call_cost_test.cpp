#include <algorithm>
#include <array>
#include <catch2/catch.hpp>
#include <cstdlib>
#include <iostream>

#include "calls/configuration.hpp"
#include "test/tools/places.hpp"

using namespace skein::benchmarks;
using skein::test::built_file;
using skein::test::built_library;

namespace {

constexpr std::size_t kWarmCalls = 2000;
constexpr std::size_t kCalls = 500;
constexpr std::size_t kStretches = 9;
constexpr std::size_t kBytes = 16;

// Discovery and the vendors' timers go on meanwhile, and what is acknowledged together differs.
constexpr double kNoise = 0.25;

/// Commands that either process answers with a count of what it has done so far.
constexpr std::array<const char*, 2> kCounts{"allocations", "sleeps"};

struct Cost {
  double server = 0;
  double client = 0;
};
using Costs = std::array<Cost, kCounts.size()>;

double count_of(Child& peer, const char* count) {
  peer.send(count);
  return std::stod(peer.receive());
}

double median_of(std::array<double, kStretches> values) {
  std::ranges::nth_element(values, values.begin() + kStretches / 2);
  return values[kStretches / 2];
}

/// By how much a call raises each count, once all caches are warm: the median of several stretches.
Costs measure(const Configuration& configuration) {
  Running running(configuration);
  running.place(Placement::OneCore);
  running.call(kBytes, kWarmCalls);
  const auto so_far = [&] {
    Costs costs;
    for (std::size_t i = 0; i < kCounts.size(); ++i)
      costs[i] = {count_of(*running.server, kCounts[i]), count_of(running.client, kCounts[i])};
    return costs;
  };
  std::array<std::array<double, kStretches>, kCounts.size()> server, client;
  for (std::size_t stretch = 0; stretch < kStretches; ++stretch) {
    const Costs before = so_far();
    running.call(kBytes, kCalls);
    const Costs after = so_far();
    for (std::size_t i = 0; i < kCounts.size(); ++i) {
      server[i][stretch] = (after[i].server - before[i].server) / kCalls;
      client[i][stretch] = (after[i].client - before[i].client) / kCalls;
    }
  }
  Costs costs;
  for (std::size_t i = 0; i < kCounts.size(); ++i)
    costs[i] = {median_of(server[i]), median_of(client[i])};
  return costs;
}

}  // namespace

TEST_CASE(
    "a steady call over a vendor allocates no more, and puts its threads to sleep no more often, "
    "than the vendor's own") {
  setenv("LD_PRELOAD", built_library("libskein_bench_allocation_counter.so").c_str(), 1);
  Configurations configurations(built_file("bin"));
  for (const char* vendor : kVendors) {
    DYNAMIC_SECTION(vendor) {
      try {
        const Costs raw = measure(configurations.raw(vendor, vendor));
        const Costs own = measure(configurations.skein(vendor, vendor));
        for (std::size_t i = 0; i < kCounts.size(); ++i) {
          std::cout << vendor << ": " << kCounts[i] << " of a call " << own[i].server
                    << " at the server, " << own[i].client << " at the client; raw "
                    << raw[i].server << ", " << raw[i].client << '\n';
          CHECK(own[i].server <= raw[i].server + kNoise);
          CHECK(own[i].client <= raw[i].client + kNoise);
        }
      } catch (const Skipped& reason) {
        std::cout << reason.what() << '\n';
        std::exit(77);
      }
    }
  }
}
