#include "traffic/encounter.hpp"

#include <cmath>

namespace reconnaissance {

std::optional<TrafficState> on_collision_course(const TrafficState& own, double direction_rad,
                                                double distance_m, double speed_m_s) {
  const double north = distance_m * std::cos(direction_rad);
  const double east = distance_m * std::sin(direction_rad);
  // |own velocity * t - way| = speed * t.
  const double a =
      own.north_m_s * own.north_m_s + own.east_m_s * own.east_m_s - speed_m_s * speed_m_s;
  const double b = -2 * (own.north_m_s * north + own.east_m_s * east);
  const double c = distance_m * distance_m;
  const double root = b * b - 4 * a * c;
  if (root < 0) return std::nullopt;
  double soonest = -1;
  for (const double sign : {-1.0, 1.0}) {
    const double t = a == 0 ? -c / b : (-b + sign * std::sqrt(root)) / (2 * a);
    if (t > 0 && (soonest < 0 || t < soonest)) soonest = t;
  }
  if (!(soonest > 0)) return std::nullopt;
  TrafficState other;
  other.place = {own.place.north_m + north, own.place.east_m + east, own.place.height_m};
  other.north_m_s = own.north_m_s - north / soonest;
  other.east_m_s = own.east_m_s - east / soonest;
  return other;
}

}  // namespace reconnaissance
