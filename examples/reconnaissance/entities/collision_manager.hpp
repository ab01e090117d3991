#pragma once

#include "flight.idl.hpp"
#include "member.hpp"
#include "picture.idl.hpp"
#include "skein/entity.hpp"
#include "skein/parameters.hpp"
#include "stream.hpp"

namespace reconnaissance {

/// Will keep the aircraft well clear of others, against the route if it must. As yet it takes part
/// in the mission's time, tells its health, and listens.
class CollisionManager {
 public:
  CollisionManager(skein::Entity& entity, const skein::ParameterValues& values);
  void start() { member_.start(); }

 private:
  Stream<recon::FlightState> flight_;
  skein::Subscription<recon::Intruder> intruders_;
  Member member_;
};

}  // namespace reconnaissance
