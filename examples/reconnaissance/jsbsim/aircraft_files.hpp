#pragma once

#include <string>
#include <vector>

#include "process.hpp"

namespace reconnaissance {

/// The name of our aircraft, and its files below JSBSim's root, which are those of this folder.
inline constexpr const char* kJsbsimAircraft = "tactical_uav";
std::vector<RootFile> jsbsim_aircraft_files();

}  // namespace reconnaissance
