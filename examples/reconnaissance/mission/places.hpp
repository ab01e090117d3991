#pragma once

#include <cstdint>
#include <iosfwd>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "flight/pilot.hpp"
#include "flight/sensor_fault.hpp"
#include "geodesy/local_frame.hpp"

namespace reconnaissance {

/// What stands between separators or on lines of its own, without the blanks around it; nothing of
/// what is blank.
std::vector<std::string> parts_of(const std::string& text, char separator);

/// The numbers that are left; nothing if a word is no number, or is further from 0 than ten
/// million, which are more metres and seconds than any mission has.
std::optional<std::vector<double>> remaining_numbers(std::istream& words);

/// A runway as a profile names it: `latitude longitude height course length`, in degrees and
/// metres. Throws skein::InvalidArgument with what is wrong.
struct RunwayText {
  Geodetic threshold{};
  double course_rad = 0;
  double length_m = 0;
};
RunwayText parse_runway(const std::string& text);

/// Several, separated by semicolons.
std::vector<RunwayText> parse_runways(const std::string& text);

/// Sites of the air defence as a profile names them: `type latitude longitude active`, in degrees,
/// and from how many seconds of the mission on it transmits; behind that, for one that lies in
/// wait, to how many metres the aircraft has to come before it does. Separated by semicolons. Their
/// height is 0. Throws likewise.
struct SiteText {
  std::string type;
  Geodetic place{};
  double active_from_s = 0;
  double silent_beyond_m = std::numeric_limits<double>::infinity();
};
std::vector<SiteText> parse_sites(const std::string& text);

/// Intruders as a profile names them: `seconds direction distance speed`; separated by semicolons.
/// So many seconds after the mission's beginning one appears, so many degrees to the right of the
/// course of the aircraft and so far away, on collision course. Throws likewise.
struct IntruderText {
  double from_s = 0;
  double direction_rad = 0;
  double distance_m = 0;
  double speed_m_s = 0;
};
std::vector<IntruderText> parse_intruders(const std::string& text);

/// Failures of sensors as a profile names them: `set kind from until`, separated by semicolons: of
/// the set 1, 2 or 3, a kind in PX4's words (off, stuck, garbage, wrong, slow, delayed,
/// intermittent), and between which seconds of the mission. Throws likewise.
struct FailureText {
  std::size_t set = 0;  ///< From 0.
  SensorFailure kind = SensorFailure::None;
  double from_s = 0;
  double until_s = 0;
};
std::vector<FailureText> parse_failures(const std::string& text);

/// Failures of planners as a profile names them: `request kind`, separated by semicolons: at which
/// of the requests for a way, from 1, the process of the planner that is asked is killed or
/// stopped. Throws likewise.
struct PlannerFailureText {
  std::uint32_t request = 0;
  bool stopped = false;  ///< It does not answer any more; otherwise it is killed.
};
std::vector<PlannerFailureText> parse_planner_failures(const std::string& text);

/// Names that are separated by commas.
inline std::vector<std::string> parse_names(const std::string& text) { return parts_of(text, ','); }

}  // namespace reconnaissance
