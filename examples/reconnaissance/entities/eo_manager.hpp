#pragma once

#include "flight.idl.hpp"
#include "member.hpp"
#include "picture.idl.hpp"
#include "skein/entity.hpp"
#include "skein/parameters.hpp"
#include "stream.hpp"

namespace reconnaissance {

/// The electro-optical camera: will point it at what is to be reconnoitred, and report pictures. As
/// yet it takes part in the mission's time, tells its health, and listens.
class EoManager {
 public:
  EoManager(skein::Entity& entity, const skein::ParameterValues& values);
  void start() { member_.start(); }

 private:
  Stream<recon::FlightState> flight_;
  skein::Subscription<recon::ElementOfInterest> elements_;
  Member member_;
};

}  // namespace reconnaissance
