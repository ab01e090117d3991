#pragma once

#include <deque>
#include <string>
#include <vector>

#include "geodesy/local_frame.hpp"
#include "in_system.hpp"
#include "skein/entity.hpp"
#include "stream.hpp"
#include "threats.idl.hpp"
#include "threats/joint_picture.hpp"

namespace reconnaissance {

/// The ground station's end of the link: makes one threat picture of what all aircraft report, and
/// sends it to each. One thread at a time may use it.
class ThreatLink {
 public:
  /// To the aircraft of these systems. Places are computed in `frame`.
  ThreatLink(skein::Entity& entity, const LocalFrame& frame,
             const std::vector<std::string>& systems);

  /// To be called twice a second of the mission. Takes the reports of half a second before: those
  /// of this tick wait for the picture.
  void relay(Tick tick);

 private:
  struct End {
    explicit End(const InSystem& system);

    std::string aircraft;
    Stream<recon::LinkedSites> reports;
    skein::Publisher<recon::LinkedSites> pictures;
  };

  LocalFrame frame_;
  JointPicture picture_;
  std::deque<End> ends_;
};

}  // namespace reconnaissance
