#pragma once

#include "flight.idl.hpp"
#include "member.hpp"
#include "picture.idl.hpp"
#include "skein/entity.hpp"
#include "skein/parameters.hpp"
#include "stream.hpp"

namespace reconnaissance {

/// Will make tracks of the objects in the pictures of the camera. As yet it takes part in the
/// mission's time, tells its health, and listens.
class ObjectTracker {
 public:
  ObjectTracker(skein::Entity& entity, const skein::ParameterValues& values);
  void start() { member_.start(); }

 private:
  Stream<recon::FlightState> flight_;
  skein::Subscription<recon::ImageReport> images_;
  Member member_;
};

}  // namespace reconnaissance
