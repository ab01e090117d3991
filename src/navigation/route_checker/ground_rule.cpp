#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "rules.hpp"

namespace skein::navigation::route_checker {
namespace {

/// The ground within one cell: h = base + by_x x + by_y y + by_xy x y, with x to the north and y to
/// the east in posts, counted from the grid's corner.
struct Patch {
  double base, by_x, by_y, by_xy;

  Patch(const HeightGrid& ground, double x, double y) {
    const int i = std::clamp(static_cast<int>(x), 0, ground.rows - 2);
    const int j = std::clamp(static_cast<int>(y), 0, ground.columns - 2);
    const auto post = [&](int row, int column) {
      return static_cast<double>(ground.heights_m[static_cast<std::size_t>(row) *
                                                      static_cast<std::size_t>(ground.columns) +
                                                  static_cast<std::size_t>(column)]);
    };
    const double h00 = post(i, j);
    by_xy = post(i + 1, j + 1) - post(i + 1, j) - post(i, j + 1) + h00;
    by_x = post(i + 1, j) - h00 - by_xy * j;
    by_y = post(i, j + 1) - h00 - by_xy * i;
    base = h00 - (post(i + 1, j) - h00) * i - (post(i, j + 1) - h00) * j + by_xy * i * j;
  }

  double at(double x, double y) const { return base + by_x * x + by_y * y + by_xy * x * y; }
};

/// Appends the places at which a coordinate passes a line between cells.
void add_crossings(std::vector<double>& places, double from, double to) {
  const double low = std::min(from, to);
  const double high = std::max(from, to);
  for (double line = std::ceil(low); line <= high; line += 1) {
    if (to != from) places.push_back(std::clamp((line - from) / (to - from), 0.0, 1.0));
  }
}

}  // namespace

double ground_height(const HeightGrid& ground, double north_m, double east_m) {
  const double x = std::clamp(north_m / ground.north_spacing_m, 0.0, ground.rows - 1.0);
  const double y = std::clamp(east_m / ground.east_spacing_m, 0.0, ground.columns - 1.0);
  return Patch(ground, x, y).at(x, y);
}

double lowest_height(const HeightGrid& ground, const AE_navigator::Position& a,
                     const AE_navigator::Position& b) {
  const double ax = a.north_m / ground.north_spacing_m;
  const double ay = a.east_m / ground.east_spacing_m;
  const double bx = b.north_m / ground.north_spacing_m;
  const double by = b.east_m / ground.east_spacing_m;
  std::vector<double> places{0, 1};
  add_crossings(places, ax, bx);
  add_crossings(places, ay, by);
  std::sort(places.begin(), places.end());

  double lowest = std::numeric_limits<double>::infinity();
  for (std::size_t i = 1; i < places.size(); ++i) {
    const double middle = (places[i - 1] + places[i]) / 2;
    const Patch patch(ground, ax + middle * (bx - ax), ay + middle * (by - ay));
    const auto height = [&](double t) {
      return a.altitude_m + t * (b.altitude_m - a.altitude_m) -
             patch.at(ax + t * (bx - ax), ay + t * (by - ay));
    };
    lowest = std::min({lowest, height(places[i - 1]), height(places[i])});
    // Over one patch the height is a parabola in t; its bottom is where its slope is zero.
    const double curvature = -2 * patch.by_xy * (bx - ax) * (by - ay);
    const double slope_at_0 = (b.altitude_m - a.altitude_m) - patch.by_x * (bx - ax) -
                              patch.by_y * (by - ay) -
                              patch.by_xy * (ax * (by - ay) + ay * (bx - ax));
    if (curvature > 0) {
      const double bottom = -slope_at_0 / curvature;
      if (bottom > places[i - 1] && bottom < places[i]) lowest = std::min(lowest, height(bottom));
    }
  }
  return lowest;
}

}  // namespace skein::navigation::route_checker
