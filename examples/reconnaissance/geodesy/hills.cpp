#include "geodesy/hills.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "random.hpp"

namespace reconnaissance {
namespace {

constexpr int kRidges = 24;
constexpr double kSpread_m = 35000;
constexpr double kPlain_m = 9000;
constexpr double kFullHeight_m = 14000;
// A ridge is a normal curve, of which further away nothing is left.
constexpr double kDeviations = 4;

double drawn_between(Random& random, double least, double greatest) {
  return std::lerp(least, greatest, random.uniform());
}

}  // namespace

Hills::Hills(double airfield_height_m, std::uint64_t seed) : airfield_height_m_(airfield_height_m) {
  if (seed == 0) return;
  Random random(seed);
  for (int i = 0; i < kRidges; ++i) {
    Ridge ridge{};
    ridge.north_m = drawn_between(random, -kSpread_m, kSpread_m);
    ridge.east_m = drawn_between(random, -kSpread_m, kSpread_m);
    const double along_rad = drawn_between(random, 0, std::numbers::pi);
    ridge.along_north = std::cos(along_rad);
    ridge.along_east = std::sin(along_rad);
    ridge.half_length_m = drawn_between(random, 3000, 8000);
    ridge.half_width_m = drawn_between(random, 800, 2000);
    ridge.height_m = drawn_between(random, 80, 330);
    ridges_.push_back(ridge);
  }
}

double Hills::operator()(double north_m, double east_m) const {
  const double away_m = std::hypot(north_m, east_m);
  if (away_m <= kPlain_m) return airfield_height_m_;
  double sum_m = 0;
  for (const Ridge& ridge : ridges_) {
    const double north = north_m - ridge.north_m, east = east_m - ridge.east_m;
    const double along =
        (north * ridge.along_north + east * ridge.along_east) / ridge.half_length_m;
    const double across =
        (east * ridge.along_north - north * ridge.along_east) / ridge.half_width_m;
    const double squared = along * along + across * across;
    if (squared < kDeviations * kDeviations) sum_m += ridge.height_m * std::exp(-squared / 2);
  }
  const double rise = std::clamp((away_m - kPlain_m) / (kFullHeight_m - kPlain_m), 0.0, 1.0);
  const double share = rise * rise * (3 - 2 * rise);
  return airfield_height_m_ + share * kHighest_m * (1 - std::exp(-sum_m / kHighest_m));
}

}  // namespace reconnaissance
