#pragma once

#include <cstdint>
#include <optional>

#include "traffic/well_clear.hpp"

namespace reconnaissance {

/// From that number on, other aircraft are those of the mission; intruders have lower ones.
inline constexpr std::uint32_t kFirstCompanion = 1001;

/// An aircraft that is at a distance in a direction (clockwise from north) at the same height, on
/// the course on which it meets the own one soonest if both fly straight on; nullopt if at that
/// speed it never would.
std::optional<TrafficState> on_collision_course(const TrafficState& own, double direction_rad,
                                                double distance_m, double speed_m_s);

}  // namespace reconnaissance
