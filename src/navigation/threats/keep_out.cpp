#include "navigation/threats/keep_out.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "navigation/terrain/plane_geometry.hpp"

namespace skein::navigation {

KeepOut::KeepOut(const AE_navigator::NoFlyZone& zone, double buffer_m)
    : name_(zone.name),
      outline_(zone.outline),
      margin_m_(zone.margin_m + buffer_m),
      floor_m_(zone.floor_m - buffer_m),
      ceiling_m_(zone.ceiling_m + buffer_m) {
  const auto [south, north] = std::minmax_element(
      outline_.begin(), outline_.end(),
      [](const GroundPoint& a, const GroundPoint& b) { return a.north_m < b.north_m; });
  const auto [west, east] = std::minmax_element(
      outline_.begin(), outline_.end(),
      [](const GroundPoint& a, const GroundPoint& b) { return a.east_m < b.east_m; });
  south_west_ = {south->north_m - margin_m_, west->east_m - margin_m_};
  north_east_ = {north->north_m + margin_m_, east->east_m + margin_m_};
}

bool KeepOut::inside(const GroundPoint& point) const noexcept {
  bool inside = false;
  for (std::size_t i = 0, j = outline_.size() - 1; i < outline_.size(); j = i++) {
    const GroundPoint& a = outline_[i];
    const GroundPoint& b = outline_[j];
    if ((a.north_m > point.north_m) == (b.north_m > point.north_m)) continue;
    const double share = (point.north_m - a.north_m) / (b.north_m - a.north_m);
    if (point.east_m < a.east_m + share * (b.east_m - a.east_m)) inside = !inside;
  }
  return inside;
}

double KeepOut::distance_m(const GroundPoint& point) const noexcept {
  if (inside(point)) return 0;
  double nearest = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0, j = outline_.size() - 1; i < outline_.size(); j = i++) {
    nearest = std::min(nearest, navigation::distance_m(point, outline_[i], outline_[j]));
  }
  return std::max(0.0, nearest - margin_m_);
}

bool KeepOut::crossed_on_map(const GroundPoint& a, const GroundPoint& b) const noexcept {
  if (std::max(a.north_m, b.north_m) < south_west_.north_m ||
      std::min(a.north_m, b.north_m) > north_east_.north_m ||
      std::max(a.east_m, b.east_m) < south_west_.east_m ||
      std::min(a.east_m, b.east_m) > north_east_.east_m) {
    return false;
  }
  if (inside(a)) return true;
  for (std::size_t i = 0, j = outline_.size() - 1; i < outline_.size(); j = i++) {
    if (navigation::distance_m(a, b, outline_[i], outline_[j]) <= margin_m_) return true;
  }
  return false;
}

bool KeepOut::crossed_by(const Position& a, const Position& b) const noexcept {
  double from = 0;
  double to = 1;
  const double climb = b.altitude_m - a.altitude_m;
  if (climb == 0) {
    if (a.altitude_m < floor_m_ || a.altitude_m > ceiling_m_) return false;
  } else {
    const double at_floor = (floor_m_ - a.altitude_m) / climb;
    const double at_ceiling = (ceiling_m_ - a.altitude_m) / climb;
    from = std::max(from, std::min(at_floor, at_ceiling));
    to = std::min(to, std::max(at_floor, at_ceiling));
    if (from > to) return false;
  }
  return crossed_on_map(between(on_map(a), on_map(b), from), between(on_map(a), on_map(b), to));
}

}  // namespace skein::navigation
