#pragma once

#include "flight.idl.hpp"
#include "member.hpp"
#include "picture.idl.hpp"
#include "skein/entity.hpp"
#include "skein/parameters.hpp"
#include "stream.hpp"

namespace reconnaissance {

/// The air defence picture: will know where threats are, how certainly, and how far they reach. As
/// yet it takes part in the mission's time, tells its health, and listens.
class AdManager {
 public:
  AdManager(skein::Entity& entity, const skein::ParameterValues& values);
  void start() { member_.start(); }

 private:
  Stream<recon::FlightState> flight_;
  skein::Subscription<recon::EmitterReport> emitters_;
  Member member_;
};

}  // namespace reconnaissance
