#pragma once

#include <cstdio>
#include <cstdlib>
#include <random>
#include <string>

namespace skein::test {

/// What this run's chances are drawn from: SKEIN_SEED, or a new one, which is printed.
inline std::uint64_t seed_of_this_run() {
  static const std::uint64_t seed = [] {
    const char* given = std::getenv("SKEIN_SEED");
    const std::uint64_t number = given ? std::stoull(given) : std::random_device{}();
    std::printf("SKEIN_SEED=%llu\n", static_cast<unsigned long long>(number));
    return number;
  }();
  return seed;
}

}  // namespace skein::test
