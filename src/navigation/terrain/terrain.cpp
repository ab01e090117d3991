#include "navigation/terrain/terrain.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>

#include "skein/error.hpp"

namespace skein::navigation {

Terrain::Terrain(std::string name, int rows, int columns, double north_spacing_m,
                 double east_spacing_m, std::vector<float> heights_m,
                 std::optional<EarthFrame> frame)
    : name_(std::move(name)),
      rows_(rows),
      columns_(columns),
      north_spacing_m_(north_spacing_m),
      east_spacing_m_(east_spacing_m),
      heights_m_(std::move(heights_m)),
      frame_(frame) {
  if (rows < 2 || columns < 2) {
    throw InvalidArgument(fmt::format("terrain '{}' has {} x {} posts; two by two are the least",
                                      name_, rows, columns));
  }
  if (!(north_spacing_m > 0 && east_spacing_m > 0)) {
    throw InvalidArgument(
        fmt::format("terrain '{}' has posts {} m by {} m apart; distances are "
                    "greater than zero",
                    name_, north_spacing_m, east_spacing_m));
  }
  if (heights_m_.size() != static_cast<std::size_t>(rows) * static_cast<std::size_t>(columns)) {
    throw InvalidArgument(fmt::format("terrain '{}' has {} heights for {} x {} posts", name_,
                                      heights_m_.size(), rows, columns));
  }
  if (!std::all_of(heights_m_.begin(), heights_m_.end(),
                   [](float height) { return std::isfinite(height); })) {
    throw InvalidArgument(fmt::format("terrain '{}' has a height that is not finite", name_));
  }
  const auto [lowest, highest] = std::minmax_element(heights_m_.begin(), heights_m_.end());
  lowest_m_ = *lowest;
  highest_m_ = *highest;
}

bool Terrain::contains(double north_m, double east_m) const noexcept {
  return north_m >= 0 && east_m >= 0 && north_m <= north_extent_m() && east_m <= east_extent_m();
}

double Terrain::height_m(double north_m, double east_m) const noexcept {
  const double u = std::clamp(north_m / north_spacing_m_, 0.0, static_cast<double>(rows_ - 1));
  const double v = std::clamp(east_m / east_spacing_m_, 0.0, static_cast<double>(columns_ - 1));
  const int row = std::min(static_cast<int>(u), rows_ - 2);
  const int column = std::min(static_cast<int>(v), columns_ - 2);
  const double fu = u - row;
  const double fv = v - column;
  const float* south = &heights_m_[index(row, column)];
  const float* north = south + columns_;
  return (1 - fu) * ((1 - fv) * south[0] + fv * south[1]) +
         fu * ((1 - fv) * north[0] + fv * north[1]);
}

}  // namespace skein::navigation
