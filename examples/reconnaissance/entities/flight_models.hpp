#pragma once

#include "flight.idl.hpp"
#include "flight/point_mass.hpp"

namespace reconnaissance {

/// A flight model that is a function of the state before: a CSP of the flight simulator.
class FlightModel : public recon::IFlightModel {
 public:
  using Advance = decltype(&reconnaissance::advance);

  explicit FlightModel(Advance advance) : advance_(advance) {}

  void place(const recon::ModelState& state) override;
  recon::ModelState advance(const recon::ModelInput& input) override;

 private:
  Advance advance_;
  Airframe airframe_;
  Aircraft aircraft_;
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
