#pragma once

#include <string>
#include <vector>

#include "navigator.idl.hpp"

namespace skein::navigation {

/// A no-fly zone, widened by a buffer, as planners see it.
///
/// Distances to the outline are exact; no curve is replaced by an inscribed polygon, so what passes
/// here is outside of the zone by the buffer at least. All questions are about closed sets:
/// touching the widened zone is entering it.
class KeepOut {
 public:
  /// `buffer_m` is added to the zone's margin, its floor and its ceiling.
  KeepOut(const AE_navigator::NoFlyZone& zone, double buffer_m);

  const std::string& name() const noexcept { return name_; }
  double floor_m() const noexcept { return floor_m_; }
  double ceiling_m() const noexcept { return ceiling_m_; }

  /// Distance from the point to the widened outline on the map, 0 inside. Altitudes do not count.
  double distance_m(const AE_navigator::GroundPoint& point) const noexcept;

  /// Whether the edge enters the zone's outline on the map, at whatever altitude.
  bool crossed_on_map(const AE_navigator::GroundPoint& a,
                      const AE_navigator::GroundPoint& b) const noexcept;

  /// Whether the edge enters the zone: on the map, at an altitude between floor and ceiling.
  bool crossed_by(const AE_navigator::Position& a, const AE_navigator::Position& b) const noexcept;

  bool contains(const AE_navigator::Position& point) const noexcept {
    return crossed_by(point, point);
  }

 private:
  bool inside(const AE_navigator::GroundPoint& point) const noexcept;

  std::string name_;
  std::vector<AE_navigator::GroundPoint> outline_;
  double margin_m_;
  double floor_m_;
  double ceiling_m_;
  AE_navigator::GroundPoint south_west_;  ///< Of the box around the widened outline.
  AE_navigator::GroundPoint north_east_;
};

}  // namespace skein::navigation
