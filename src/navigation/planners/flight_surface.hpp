#pragma once

#include <vector>

#include "navigation/terrain/planning_grid.hpp"
#include "navigation/terrain/terrain.hpp"
#include "navigator.idl.hpp"

namespace skein::navigation {

/// How wide a berth a search gives to zones and closed ground: as little as is safe, or so much
/// that a turn around their corners, which flies inside of the corner of its path, stays clear of
/// them too.
enum class Berth { Least, ForTurns };

/// The altitude to fly at, over every node of a grid: the lowest surface that clears the ground,
/// meets start and goal, and is nowhere steeper than the aircraft climbs. Whoever flies along it in
/// any direction respects the climb limit, so that a search needs two dimensions only.
///
/// Ground that would have to be climbed more steeply from the start or before the goal, or that is
/// too high for the maximum altitude, is closed: a wall to fly around, which does not lift the
/// surface beside it.
class FlightSurface {
 public:
  FlightSurface(const Terrain& terrain, const AE_navigator::Problem& problem, PlanningGrid grid);

  const PlanningGrid& grid() const { return grid_; }

  bool open(int node, Berth berth) const {
    return (berth == Berth::Least ? open_ : roomy_)[static_cast<std::size_t>(node)];
  }
  double altitude_m(int node) const { return altitude_m_[static_cast<std::size_t>(node)]; }
  const std::vector<float>& altitudes_m() const { return altitude_m_; }

  /// Whether all nodes of the point's cell are open; on a line between two nodes only they count.
  bool open(const GroundPoint& point, Berth berth) const;
  double altitude_m(const GroundPoint& point) const {
    return grid_.interpolate(altitude_m_, point);
  }

 private:
  void clear_the_ground(const Terrain& terrain, double height_m);
  void close_what_is_too_high(const AE_navigator::Problem& problem, double slope);
  void touch(const AE_navigator::Position& end, double slope);
  void limit_slope(double slope);
  void leave_room(const AE_navigator::Problem& problem);

  PlanningGrid grid_;
  std::vector<float> altitude_m_;
  std::vector<bool> open_;
  std::vector<bool> roomy_;  ///< Open, and all neighbours too.
};

}  // namespace skein::navigation
