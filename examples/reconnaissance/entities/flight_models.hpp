#pragma once

#include <string>

#include "flight.idl.hpp"
#include "flight/point_mass.hpp"
#include "jsbsim/flight.hpp"
#include "skein/parameters.hpp"

namespace reconnaissance {

/// A flight model that is a function of the state before: a CSP of the flight simulator.
class FlightModel : public recon::IFlightModel {
 public:
  using Advance = decltype(&reconnaissance::advance);

  /// `Aircraft` names which one it is.
  FlightModel(const skein::ParameterValues& values, Advance advance);

  void place(const recon::ModelState& state) override;
  recon::ModelState advance(const recon::ModelInput& input) override;

 private:
  Advance advance_;
  Airframe airframe_;
  Aircraft aircraft_;
};

/// JSBSim as a CSP: what it cannot do is refused, with the reason.
class JsbsimModel : public recon::IFlightModel {
 public:
  explicit JsbsimModel(const skein::ParameterValues& values);

  void place(const recon::ModelState& state) override;
  recon::ModelState advance(const recon::ModelInput& input) override;

 private:
  JsbsimFlight flight_;
};

/// A guidance along legs and circles: a CSP of the flight controller.
class L1Guidance : public recon::IGuidance {
 public:
  double bank_rad(const recon::GuidanceInput& input) override;
};

class CarrotGuidance : public recon::IGuidance {
 public:
  double bank_rad(const recon::GuidanceInput& input) override;
};

}  // namespace reconnaissance
