#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "threats/air_defence_picture.hpp"

namespace reconnaissance {

/// One picture of the air defence from those of several aircraft.
///
/// Each reports what its own warner has found, and nothing that came over the link. Reports of one
/// type by different aircraft that agree (gate of 99 %) are one site, placed by covariance
/// intersection: what the errors of two aircraft have in common, for example by the same
/// satellites, is unknown. A report joins the site that it agrees with best. Who takes the joint
/// picture into its own does so by covariance intersection, too (AirDefencePicture), and reports
/// its own as before: so nothing counts twice, however often pictures go round.
///
/// One thread at a time may use it.
class JointPicture {
 public:
  struct Site {
    std::uint32_t id;  ///< Stays, as long as the first of those who report it does.
    std::string emitter;
    skein::fusion::Estimate position;    ///< North and east.
    std::vector<std::string> reporters;  ///< The aircraft, in their alphabetical order.
  };

  /// All that an aircraft knows by itself now, in place of what it reported before. Places of all
  /// aircraft are from one origin.
  void report(const std::string& aircraft, std::vector<LinkTrack> sites);

  /// In the order of their first reporters and these one's numbers.
  std::vector<Site> sites();

 private:
  std::map<std::string, std::vector<LinkTrack>> reports_;
  std::map<std::pair<std::string, std::uint32_t>, std::uint32_t> ids_;  // of each report
};

}  // namespace reconnaissance
