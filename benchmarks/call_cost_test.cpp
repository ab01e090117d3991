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

// Discovery and the vendors' timers go on meanwhile, and what is acknowledged together differs,
// most of all on a busy machine: that moves the vendors' locks by two or three, and their blocks by
// half a one.
constexpr double kNoise = 0.25;

struct Cost {
  double server = 0;
  double client = 0;
};

/// A command that either process answers with a count of what it has done so far; and what a call
/// may cost: by how much more than with the vendor's own interface, and through shared memory.
struct Count {
  const char* command;
  Cost beyond_vendor;
  Cost through_shared_memory;
};
constexpr std::array<Count, 5> kCounts{{{"sleeps", {0, 0}, {1, 1}},
                                        {"counted allocations", {0.3, 0.3}, {2.5, 1.5}},
                                        {"counted locks", {18, 12}, {17, 14}},
                                        {"counted clock_readings", {5, 2}, {3, 4}},
                                        {"counted system_calls", {0, 0}, {2, 2}}}};
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
/// Skipped if a program or a library is not here.
Costs measure(const Configuration& configuration) try {
  setenv("LD_PRELOAD", built_library("libskein_bench_work_counter.so").c_str(), 1);
  Running running(configuration);
  running.place(Placement::OneCore);
  running.call(kBytes, kWarmCalls);
  const auto so_far = [&] {
    Costs costs;
    for (std::size_t i = 0; i < kCounts.size(); ++i)
      costs[i] = {count_of(*running.server, kCounts[i].command),
                  count_of(running.client, kCounts[i].command)};
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
  for (std::size_t i = 0; i < kCounts.size(); ++i) {
    costs[i] = {median_of(server[i]), median_of(client[i])};
    std::cout << configuration.name << ": " << kCounts[i].command << ' ' << costs[i].server
              << " at the server, " << costs[i].client << " at the client\n";
  }
  return costs;
} catch (const Skipped& reason) {
  std::cout << reason.what() << '\n';
  std::exit(77);
}

}  // namespace

TEST_CASE("a steady call over a vendor costs little more than with the vendor's own interface") {
  Configurations configurations(built_file("bin"));
  for (const char* vendor : kVendors) {
    DYNAMIC_SECTION(vendor) {
      const Costs raw = measure(configurations.raw(vendor, vendor));
      const Costs own = measure(configurations.skein(vendor, vendor));
      for (std::size_t i = 0; i < kCounts.size(); ++i) {
        CAPTURE(kCounts[i].command);
        CHECK(own[i].server <= raw[i].server + kCounts[i].beyond_vendor.server + kNoise);
        CHECK(own[i].client <= raw[i].client + kCounts[i].beyond_vendor.client + kNoise);
      }
    }
  }
}

TEST_CASE("a steady call through shared memory takes two system calls a side, and one sleep") {
  Configurations configurations(built_file("bin"));
  const Costs own = measure(configurations.skein_same_host(Configurations::SharedMemory::Sleeping));
  for (std::size_t i = 0; i < kCounts.size(); ++i) {
    CAPTURE(kCounts[i].command);
    CHECK(own[i].server <= kCounts[i].through_shared_memory.server + kNoise);
    CHECK(own[i].client <= kCounts[i].through_shared_memory.client + kNoise);
  }
}
