#pragma once

#include <string>
#include <vector>

#include "flight/pilot.hpp"
#include "geodesy/local_frame.hpp"

namespace reconnaissance {

/// A runway as a profile names it: `latitude longitude height course length`, in degrees and
/// metres. Throws skein::InvalidArgument with what is wrong.
struct RunwayText {
  Geodetic threshold{};
  double course_rad = 0;
  double length_m = 0;
};
RunwayText parse_runway(const std::string& text);

/// Sites of the air defence as a profile names them: `type latitude longitude active`, in degrees,
/// and from how many seconds of the mission on it transmits; separated by semicolons. Their height
/// is 0. Throws likewise.
struct SiteText {
  std::string type;
  Geodetic place{};
  double active_from_s = 0;
};
std::vector<SiteText> parse_sites(const std::string& text);

/// Names that are separated by commas.
std::vector<std::string> parse_names(const std::string& text);

}  // namespace reconnaissance
