#pragma once

#include <cstdint>
#include <vector>

namespace reconnaissance {

/// Invented ground: a plain about an airfield, and ridges further away than 9 km from it. The seed
/// makes the same ones everywhere.
class Hills {
 public:
  /// No ridge is higher than that above the airfield.
  static constexpr double kHighest_m = 400;

  /// Seed 0: the plain alone.
  Hills(double airfield_height_m, std::uint64_t seed);

  /// Above the geoid, by metres north and east of the airfield.
  double operator()(double north_m, double east_m) const;

 private:
  struct Ridge {
    double north_m, east_m;
    double along_north, along_east;  // a unit vector
    double half_length_m, half_width_m;
    double height_m;
  };

  double airfield_height_m_;
  std::vector<Ridge> ridges_;
};

}  // namespace reconnaissance
