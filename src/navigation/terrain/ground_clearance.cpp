#include "navigation/terrain/ground_clearance.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace skein::navigation {
namespace {

/// The parameters at which a coordinate that runs from `from` by `by` passes whole numbers.
class Crossings {
 public:
  Crossings(double from, double by) : from_(from), by_(by) {
    line_ = by > 0 ? std::floor(from) + 1 : std::ceil(from) - 1;
  }
  double next() const {
    return by_ == 0 ? std::numeric_limits<double>::infinity() : (line_ - from_) / by_;
  }
  void pass() { line_ += by_ > 0 ? 1 : -1; }

 private:
  double from_;
  double by_;
  double line_;
};

/// The ground as one cell continues it, so that its edges belong to it whichever way one rounds.
double cell_height(const Terrain& terrain, int row, int column, double u, double v) {
  const double fu = u - row;
  const double fv = v - column;
  return (1 - fu) *
             ((1 - fv) * terrain.post_m(row, column) + fv * terrain.post_m(row, column + 1)) +
         fu * ((1 - fv) * terrain.post_m(row + 1, column) +
               fv * terrain.post_m(row + 1, column + 1));
}

}  // namespace

GroundClearance ground_clearance(const Terrain& terrain, const AE_navigator::Position& a,
                                 const AE_navigator::Position& b) {
  const double u0 = a.north_m / terrain.north_spacing_m();
  const double v0 = a.east_m / terrain.east_spacing_m();
  const double du = b.north_m / terrain.north_spacing_m() - u0;
  const double dv = b.east_m / terrain.east_spacing_m() - v0;
  const double dz = b.altitude_m - a.altitude_m;
  Crossings rows(u0, du);
  Crossings columns(v0, dv);
  GroundClearance result{std::numeric_limits<double>::infinity(), 0};
  const auto consider = [&](double clearance, double t) {
    if (clearance < result.lowest_m) result = {clearance, t};
  };

  for (double t = 0; t < 1 || result.lowest_m == std::numeric_limits<double>::infinity();) {
    const double end = std::min({rows.next(), columns.next(), 1.0});
    const double middle = (t + end) / 2;
    const int row =
        std::clamp(static_cast<int>(std::floor(u0 + middle * du)), 0, terrain.rows() - 2);
    const int column =
        std::clamp(static_cast<int>(std::floor(v0 + middle * dv)), 0, terrain.columns() - 2);
    const auto clearance = [&](double at) {
      return a.altitude_m + at * dz - cell_height(terrain, row, column, u0 + at * du, v0 + at * dv);
    };
    // Three values determine the parabola c0 + c1 s + c2 s^2 over s = 0 .. 1.
    const double first = clearance(t);
    const double half = clearance(middle);
    const double last = clearance(end);
    const double c1 = -3 * first + 4 * half - last;
    const double c2 = 2 * first - 4 * half + 2 * last;
    consider(first, t);
    consider(last, end);
    if (c2 > 0 && c1 < 0 && -c1 < 2 * c2) {
      const double s = -c1 / (2 * c2);
      consider(first + s * (c1 + s * c2), t + s * (end - t));
    }
    if (rows.next() <= end) rows.pass();
    if (columns.next() <= end) columns.pass();
    if (end >= 1) break;
    t = end;
  }
  return result;
}

}  // namespace skein::navigation
