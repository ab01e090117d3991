#include <algorithm>
#include <catch2/catch.hpp>
#include <cstdlib>
#include <iostream>

#include "calls/configuration.hpp"

using namespace skein::benchmarks;

namespace {

constexpr std::size_t kWarmCalls = 2000;
constexpr std::size_t kCalls = 500;
constexpr int kStretches = 8;
constexpr std::size_t kBytes = 16;

// Discovery and the vendors' timers go on meanwhile.
constexpr double kNoise = 0.1;

struct Allocations {
  double server = 0;
  double client = 0;
};

double allocations_of(Child& peer) {
  peer.send("allocations");
  return std::stod(peer.receive());
}

/// Blocks that a call takes from the heap, once all caches are warm. What discovery and timers take
/// beside the calls grows with the time that these need, so the least of several stretches counts.
Allocations measure(const Configuration& configuration) {
  Running running(configuration);
  running.call(kBytes, kWarmCalls);
  const auto so_far = [&] {
    return Allocations{allocations_of(*running.server), allocations_of(running.client)};
  };
  Allocations least{kCalls, kCalls};
  for (int stretch = 0; stretch < kStretches; ++stretch) {
    const Allocations before = so_far();
    running.call(kBytes, kCalls);
    const Allocations after = so_far();
    least.server = std::min(least.server, (after.server - before.server) / kCalls);
    least.client = std::min(least.client, (after.client - before.client) / kCalls);
  }
  return least;
}

}  // namespace

TEST_CASE("a steady call over a vendor allocates no more than the vendor's own") {
  setenv("LD_PRELOAD", SKEIN_ALLOCATION_COUNTER, 1);
  Configurations configurations(SKEIN_BENCH_FOLDER);
  for (const char* vendor : kVendors) {
    DYNAMIC_SECTION(vendor) {
      try {
        const Allocations raw = measure(configurations.raw(vendor, vendor));
        const Allocations own = measure(configurations.skein(vendor, vendor));
        std::cout << vendor << ": a call allocates " << own.server << " at the server, "
                  << own.client << " at the client; raw " << raw.server << ", " << raw.client
                  << '\n';
        CHECK(own.server <= raw.server + kNoise);
        CHECK(own.client <= raw.client + kNoise);
      } catch (const Skipped& reason) {
        std::cout << reason.what() << '\n';
        std::exit(77);
      }
    }
  }
}
