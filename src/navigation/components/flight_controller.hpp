#pragma once

#include "flight_controller.idl.hpp"
#include "skein/parameters.hpp"

namespace skein::navigation {

/// The flight controller's Body: says what the aircraft can do, from the parameters `Cruising
/// speed` (m/s), `Climb angle` and `Bank angle` (degrees) and `Highest altitude` (m above mean sea
/// level). Without a value, a small fixed-wing aircraft: 60 m/s, 12 and 30 degrees, 4000 m.
class FlightController final : public AE_flightControllerI::IFlightController {
 public:
  /// Throws InvalidArgument for a value outside of the range that the IDL states.
  explicit FlightController(const ParameterValues& values);

  AE_flightControllerI::FlightLimits flight_limits() override { return limits_; }

 private:
  AE_flightControllerI::FlightLimits limits_;
};

}  // namespace skein::navigation
