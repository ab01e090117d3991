#pragma once

#include <vector>

#include "report/record.hpp"

namespace reconnaissance {

/// One record of several aircraft, of which there is one at least: the track, routes and phases of
/// the first, the tracks of the others beside it, and what happened to all, in the order of time.
/// Survival is that of all of them. A site that several know is shown where it is known best.
MissionRecord joint_record(const std::vector<OfAircraft<MissionRecord>>& records);

}  // namespace reconnaissance
