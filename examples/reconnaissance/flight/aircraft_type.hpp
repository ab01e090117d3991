#pragma once

#include <string_view>

#include "pilot.hpp"
#include "point_mass.hpp"

namespace reconnaissance {

/// An aircraft that missions may be flown with: what it can do, how it is flown, and what it burns.
struct AircraftType {
  Airframe airframe{};
  FlightRules rules{};
  double fuel_kg_s = 0;  ///< In level cruise, by no less than it takes.
};

/// `medium`: of the size of an RQ-1, the defaults of Airframe and FlightRules. `tactical`: of the
/// Aerosonde's class, 13.5 kg; jsbsim/tactical_uav.xml describes it, and says where its figures
/// come from. Throws skein::InvalidArgument for another name.
const AircraftType& aircraft_type(std::string_view name);

}  // namespace reconnaissance
