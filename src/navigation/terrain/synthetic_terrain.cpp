#include <algorithm>
#include <cmath>
#include <numbers>

#include "navigation/terrain/terrain.hpp"

namespace skein::navigation {
namespace {

/// Gradient noise on the unit lattice, about -0.7 to 0.7, smooth, with a gradient per lattice point
/// that depends on nothing but the point and the seed.
class Noise {
 public:
  explicit Noise(std::uint32_t seed) : seed_(seed) {}

  double operator()(double x, double y) const {
    const double left = std::floor(x);
    const double bottom = std::floor(y);
    const double fx = x - left;
    const double fy = y - bottom;
    const int ix = static_cast<int>(left);
    const int iy = static_cast<int>(bottom);
    const double wx = fade(fx);
    const double wy = fade(fy);
    const double low = std::lerp(slope(ix, iy, fx, fy), slope(ix + 1, iy, fx - 1, fy), wx);
    const double high =
        std::lerp(slope(ix, iy + 1, fx, fy - 1), slope(ix + 1, iy + 1, fx - 1, fy - 1), wx);
    return std::lerp(low, high, wy);
  }

  /// Octaves of halving size and amplitude.
  double rolling(double x, double y, int octaves) const {
    double sum = 0;
    for (double amplitude = 1; octaves > 0; --octaves, amplitude /= 2, x *= 2, y *= 2) {
      sum += amplitude * (*this)(x + octaves * 17.3, y - octaves * 9.1);
    }
    return sum;
  }

  /// Octaves of sharp crests; finer ones grow only where coarser ones are high, so that valleys
  /// stay smooth. About 0 to 1.
  double ridged(double x, double y, int octaves) const {
    double sum = 0;
    double weight = 1;
    for (double amplitude = 0.55; octaves > 0; --octaves, amplitude *= 0.5, x *= 2.1, y *= 2.1) {
      const double crest = 1 - std::min(1.0, 1.9 * std::abs((*this)(x, y + octaves * 31.7)));
      const double value = crest * crest * weight;
      sum += amplitude * value;
      weight = std::min(1.0, 1.6 * value);
    }
    return sum;
  }

 private:
  static double fade(double t) { return t * t * t * (t * (6 * t - 15) + 10); }

  double slope(int ix, int iy, double dx, double dy) const {
    std::uint32_t bits = seed_ * 0x9E3779B1u + static_cast<std::uint32_t>(ix) * 0x85EBCA77u +
                         static_cast<std::uint32_t>(iy) * 0xC2B2AE3Du;
    bits = (bits ^ (bits >> 15)) * 0x2C1B3C6Du;
    bits = (bits ^ (bits >> 12)) * 0x297A2D39u;
    bits ^= bits >> 15;
    const double angle = bits * (2 * std::numbers::pi / 4294967296.0);
    return std::cos(angle) * dx + std::sin(angle) * dy;
  }

  std::uint32_t seed_;
};

double smooth_step(double from, double to, double x) {
  const double t = std::clamp((x - from) / (to - from), 0.0, 1.0);
  return t * t * (3 - 2 * t);
}

}  // namespace

Terrain make_synthetic_terrain(std::uint32_t seed) {
  constexpr int kPosts = 513;
  constexpr double kSpacing_m = 100;
  const Noise warp(4 * seed), massif(4 * seed + 1), ridge(4 * seed + 2), hill(4 * seed + 3);

  std::vector<float> heights;
  heights.reserve(static_cast<std::size_t>(kPosts) * kPosts);
  for (int row = 0; row < kPosts; ++row) {
    for (int column = 0; column < kPosts; ++column) {
      const double x_km = column * kSpacing_m / 1000;
      const double y_km = row * kSpacing_m / 1000;
      const double x = x_km + 3.0 * warp.rolling(x_km / 16, y_km / 16, 3);
      const double y = y_km + 3.0 * warp.rolling(x_km / 16 + 50, y_km / 16 + 50, 3);
      const double mountains = smooth_step(-0.35, 0.4, massif.rolling(x / 26, y / 26, 2));
      const double height = 260 + 190 * hill.rolling(x / 13, y / 13, 4) +
                            mountains * 1750 * ridge.ridged(x / 15, y / 15, 6);
      heights.push_back(static_cast<float>(std::round(std::max(0.0, height) * 16) / 16));
    }
  }
  return Terrain("synthetic:" + std::to_string(seed), kPosts, kPosts, kSpacing_m, kSpacing_m,
                 std::move(heights));
}

}  // namespace skein::navigation
