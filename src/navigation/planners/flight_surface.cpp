#include "navigation/planners/flight_surface.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "navigation/planners/problem_rules.hpp"

namespace skein::navigation {
namespace {

/// A path over grid neighbours is up to this much longer than the straight line.
constexpr double kDetourOfGrid = 1.0824;

/// Near start and goal the final altitude profile decides, not the surface: within this many nodes
/// nothing is closed.
constexpr double kFreeAround = 2.0;

/// For every node the highest post no further than one node away, in rows of `count` nodes.
std::vector<float> widest(const std::vector<float>& values, int lines, int length, int count,
                          double posts_per_node) {
  std::vector<float> result(static_cast<std::size_t>(lines) * static_cast<std::size_t>(count));
  for (int line = 0; line < lines; ++line) {
    const auto begin = values.begin() + static_cast<std::ptrdiff_t>(line) * length;
    for (int node = 0; node < count; ++node) {
      const int from = std::max(0, static_cast<int>(std::floor((node - 1) * posts_per_node)));
      const int to = std::min(length - 1, static_cast<int>(std::ceil((node + 1) * posts_per_node)));
      result[static_cast<std::size_t>(node) * static_cast<std::size_t>(lines) +
             static_cast<std::size_t>(line)] = *std::max_element(begin + from, begin + to + 1);
    }
  }
  return result;  // Turned by its diagonal, ready for the other direction.
}

}  // namespace

FlightSurface::FlightSurface(const Terrain& terrain, const AE_navigator::Problem& problem,
                             PlanningGrid grid)
    : grid_(grid), open_(static_cast<std::size_t>(grid.size()), true) {
  const double slope = climb_slope(problem.limits) / kDetourOfGrid;
  clear_the_ground(terrain, problem.minimum_height_above_ground_m);
  close_what_is_too_high(problem, slope);
  touch(problem.start, slope);
  touch(problem.goal, slope);
  limit_slope(slope);
  leave_room(problem);
}

bool FlightSurface::open(const GroundPoint& point, Berth berth) const {
  constexpr double kOnLine = 1e-6;
  const PlanningGrid::Cell at = grid_.cell(point);
  for (const int rows : {0, 1}) {
    if ((rows ? at.north : 1 - at.north) < kOnLine) continue;
    for (const int columns : {0, 1}) {
      if ((columns ? at.east : 1 - at.east) < kOnLine) continue;
      if (!open(at.south_west + rows * grid_.columns() + columns, berth)) return false;
    }
  }
  return true;
}

void FlightSurface::clear_the_ground(const Terrain& terrain, double height_m) {
  const double columns_per_node = grid_.east_spacing_m() / terrain.east_spacing_m();
  const double rows_per_node = grid_.north_spacing_m() / terrain.north_spacing_m();
  const std::vector<float> by_column = widest(terrain.heights_m(), terrain.rows(),
                                              terrain.columns(), grid_.columns(), columns_per_node);
  altitude_m_ = widest(by_column, grid_.columns(), terrain.rows(), grid_.rows(), rows_per_node);
  for (float& altitude : altitude_m_) altitude += static_cast<float>(height_m);
}

void FlightSurface::close_what_is_too_high(const AE_navigator::Problem& problem, double slope) {
  for (int node = 0; node < grid_.size(); ++node) {
    const GroundPoint point = grid_.point(node);
    const double from_start = distance_m(point, on_map(problem.start));
    const double to_goal = distance_m(point, on_map(problem.goal));
    const double reachable =
        std::min({problem.start.altitude_m + slope * from_start,
                  problem.goal.altitude_m + slope * to_goal, problem.limits.maximum_altitude_m});
    float& altitude = altitude_m_[static_cast<std::size_t>(node)];
    if (altitude <= reachable) continue;
    if (std::min(from_start, to_goal) <= kFreeAround * grid_.spacing_m()) {
      altitude = static_cast<float>(reachable);
    } else {
      altitude = std::numeric_limits<float>::lowest();
      open_[static_cast<std::size_t>(node)] = false;
    }
  }
}

void FlightSurface::touch(const AE_navigator::Position& end, double slope) {
  for (int node = 0; node < grid_.size(); ++node) {
    const double below = slope * distance_m(grid_.point(node), on_map(end));
    float& altitude = altitude_m_[static_cast<std::size_t>(node)];
    altitude = std::max(altitude, static_cast<float>(end.altitude_m - below));
  }
}

void FlightSurface::leave_room(const AE_navigator::Problem& problem) {
  roomy_ = open_;
  for (int node = 0; node < grid_.size(); ++node) {
    if (open_[static_cast<std::size_t>(node)]) continue;
    for (int row = grid_.row(node) - 1; row <= grid_.row(node) + 1; ++row) {
      for (int column = grid_.column(node) - 1; column <= grid_.column(node) + 1; ++column) {
        if (!grid_.has(row, column)) continue;
        const int beside = grid_.node(row, column);
        const double to_end = std::min(distance_m(grid_.point(beside), on_map(problem.start)),
                                       distance_m(grid_.point(beside), on_map(problem.goal)));
        if (to_end > kFreeAround * grid_.spacing_m()) {
          roomy_[static_cast<std::size_t>(beside)] = false;
        }
      }
    }
  }
}

/// The upper envelope of cones on all nodes: two sweeps of a chamfer distance transform, which are
/// exact for paths along rows, columns and diagonals.
void FlightSurface::limit_slope(double slope) {
  const int rows = grid_.rows();
  const int columns = grid_.columns();
  const auto north = static_cast<float>(slope * grid_.north_spacing_m());
  const auto east = static_cast<float>(slope * grid_.east_spacing_m());
  const auto diagonal =
      static_cast<float>(slope * std::hypot(grid_.north_spacing_m(), grid_.east_spacing_m()));
  const auto lift = [&](int row, int column, int from_row, int from_column, float fall) {
    if (!grid_.has(from_row, from_column)) return;
    float& altitude = altitude_m_[static_cast<std::size_t>(grid_.node(row, column))];
    altitude = std::max(
        altitude, altitude_m_[static_cast<std::size_t>(grid_.node(from_row, from_column))] - fall);
  };
  const auto sweep = [&](int row, int column, int back) {
    lift(row, column, row, column - back, east);
    lift(row, column, row - back, column - 1, diagonal);
    lift(row, column, row - back, column, north);
    lift(row, column, row - back, column + 1, diagonal);
  };
  for (int row = 0; row < rows; ++row) {
    for (int column = 0; column < columns; ++column) sweep(row, column, 1);
  }
  for (int row = rows - 1; row >= 0; --row) {
    for (int column = columns - 1; column >= 0; --column) sweep(row, column, -1);
  }
}

}  // namespace skein::navigation
