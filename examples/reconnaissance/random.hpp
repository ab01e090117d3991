#pragma once

#include <cmath>
#include <cstdint>
#include <numbers>
#include <random>

namespace reconnaissance {

/// Random numbers that a seed makes the same with every standard library.
class Random {
 public:
  explicit Random(std::uint64_t seed) : engine_(seed) {}

  /// In [0, 1).
  double uniform() { return static_cast<double>(engine_() >> 11) * 0x1p-53; }

  /// Of mean 0 and variance 1, after Box and Muller (1958).
  double normal() {
    const double radius = std::sqrt(-2 * std::log(1 - uniform()));
    return radius * std::cos(2 * std::numbers::pi * uniform());
  }

  bool happens(double probability) { return uniform() < probability; }

 private:
  std::mt19937_64 engine_;
};

}  // namespace reconnaissance
