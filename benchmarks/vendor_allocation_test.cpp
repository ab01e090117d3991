#include <algorithm>
#include <array>
#include <catch2/catch.hpp>
#include <cstdlib>
#include <iostream>

#include "../test/tools/places.hpp"
#include "calls/configuration.hpp"

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

struct Allocations {
  double server = 0;
  double client = 0;
};

double allocations_of(Child& peer) {
  peer.send("allocations");
  return std::stod(peer.receive());
}

double median_of(std::array<double, kStretches> values) {
  std::ranges::nth_element(values, values.begin() + kStretches / 2);
  return values[kStretches / 2];
}

/// Blocks that a call takes from the heap, once all caches are warm: the median of several
/// stretches.
Allocations measure(const Configuration& configuration) {
  Running running(configuration);
  running.call(kBytes, kWarmCalls);
  const auto so_far = [&] {
    return Allocations{allocations_of(*running.server), allocations_of(running.client)};
  };
  std::array<double, kStretches> server, client;
  for (std::size_t stretch = 0; stretch < kStretches; ++stretch) {
    const Allocations before = so_far();
    running.call(kBytes, kCalls);
    const Allocations after = so_far();
    server[stretch] = (after.server - before.server) / kCalls;
    client[stretch] = (after.client - before.client) / kCalls;
  }
  return {median_of(server), median_of(client)};
}

}  // namespace

TEST_CASE("a steady call over a vendor allocates no more than the vendor's own") {
  setenv("LD_PRELOAD", built_library("libskein_bench_allocation_counter.so").c_str(), 1);
  Configurations configurations(built_file("bin"));
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
