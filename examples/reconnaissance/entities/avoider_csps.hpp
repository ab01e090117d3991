#pragma once

#include "traffic.idl.hpp"
#include "traffic/advisory.hpp"

namespace reconnaissance {

inline TrafficState traffic_state(const recon::TrafficMotion& told) {
  return {{told.north_m, told.east_m, told.height_m}, told.north_m_s, told.east_m_s, told.up_m_s};
}

/// Detect and avoid by bands: a CSP of the collision manager.
class Bands : public recon::IAvoider {
 public:
  recon::Avoidance advise(const recon::Encounter& encounter) override;

 private:
  BandsAvoider avoider_;
};

/// By a potential field.
class PotentialField : public recon::IAvoider {
 public:
  recon::Avoidance advise(const recon::Encounter& encounter) override;

 private:
  PotentialFieldAvoider avoider_;
};

}  // namespace reconnaissance
