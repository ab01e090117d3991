#pragma once

#include <algorithm>
#include <cstdint>
#include <cstdio>
#include <functional>
#include <random>
#include <string>
#include <vector>

namespace skein::benchmarks {

/// Lets all turns run once a round, in a new random order each round, so that a disturbance of
/// the machine hits all that are compared, and none always follows the same other. Progress
/// is shown on the standard error if it has a name.
inline void take_turns(std::size_t rounds, std::vector<std::function<void()>> turns,
                       std::uint32_t seed, const std::string& name = "",
                       const std::function<void(std::size_t)>& after_round = {}) {
  std::mt19937 random(seed);
  for (std::size_t round = 0; round < rounds; ++round) {
    std::shuffle(turns.begin(), turns.end(), random);
    for (const auto& turn : turns) turn();
    if (after_round) after_round(round);
    if (!name.empty())
      std::fprintf(stderr, "\r%s: round %zu of %zu ", name.c_str(), round + 1, rounds);
  }
  if (!name.empty()) std::fputc('\n', stderr);
}

}  // namespace skein::benchmarks
