#pragma once

#include "flight.idl.hpp"
#include "member.hpp"
#include "picture.idl.hpp"
#include "skein/entity.hpp"
#include "skein/parameters.hpp"
#include "stream.hpp"

namespace reconnaissance {

/// The elements of interest: will know what is to be reconnoitred, and how well each is. As yet it
/// takes part in the mission's time, tells its health, and listens.
class EoiManager {
 public:
  EoiManager(skein::Entity& entity, const skein::ParameterValues& values);
  void start() { member_.start(); }

 private:
  Stream<recon::FlightState> flight_;
  skein::Subscription<recon::ImageReport> images_;
  skein::Subscription<recon::ObjectTrack> tracks_;
  Member member_;
};

}  // namespace reconnaissance
