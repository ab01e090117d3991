#pragma once

#include "member.hpp"
#include "skein/entity.hpp"
#include "skein/parameters.hpp"
#include "stream.hpp"
#include "targets.idl.hpp"

namespace reconnaissance {

/// Follows what was found in images. Its CSPs filter; its Head fuses their tracks so that they are
/// not believed better than they are.
class ObjectTracker {
 public:
  ObjectTracker(skein::Entity& entity, const skein::ParameterValues& values);
  void start() { member_.start(); }

 private:
  void follow(Tick tick);
  recon::TrackList ask_trackers(const recon::GroundLook& look);

  skein::Entity& entity_;
  recon::ObjectTracks told_;
  Stream<recon::Images> images_;
  skein::Publisher<recon::ObjectTracks> tracks_;
  Member member_;
};

}  // namespace reconnaissance
