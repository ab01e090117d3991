#pragma once

#include "flight.idl.hpp"
#include "member.hpp"
#include "picture.idl.hpp"
#include "skein/entity.hpp"
#include "skein/parameters.hpp"
#include "stream.hpp"

namespace reconnaissance {

/// The radar warner: will tell emitters and their modes by what it receives. As yet it takes part
/// in the mission's time, tells its health, and listens.
class RadarWarner {
 public:
  RadarWarner(skein::Entity& entity, const skein::ParameterValues& values);
  void start() { member_.start(); }

 private:
  Stream<recon::FlightState> flight_;
  skein::Subscription<recon::Emission> emissions_;
  Member member_;
};

}  // namespace reconnaissance
