#pragma once

#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "geodesy/local_frame.hpp"

namespace reconnaissance {

/// What a mission must keep to pass.
struct PassConditions {
  double longest_s = 3600;         ///< From take-off to standing.
  double least_clearance_m = 100;  ///< Above ground, where it is more than 5 km from the runway.
  double least_survival = 0.95;    ///< Of the air defence, by its simulation.
  /// Of other aircraft, on the map or in height: DO-365B's en-route volume, 0.66 nautical miles and
  /// 450 ft, without its time.
  double well_clear_m = 1222.32;
  double well_clear_height_m = 137.16;
  double landed_within_m = 400;  ///< Between aiming point and touch-down.
  double least_fuel_kg = 5;      ///< When it stands.
};

/// One condition, and whether it is kept.
struct Check {
  std::string name;
  bool passed = false;
  std::string text;  ///< What was found, and what is wanted.
};

struct Verdict {
  bool flown = false;   ///< To its end: the aircraft stands after a landing.
  bool passed = false;  ///< And all conditions are kept.
  std::string reason;   ///< Of the first condition that is not kept, or why it was not flown.
  double duration_s = 0;
  double distance_m = 0;
  std::vector<Check> checks;
};

/// Something of an aircraft, by the aircraft's name.
template <class What>
struct OfAircraft {
  std::string aircraft;
  What what;
};

/// One verdict over several aircraft, of which there is one at least: flown and passed if all are.
/// It lasts as long as the longest; distances are added.
Verdict joint_verdict(const std::vector<OfAircraft<Verdict>>& verdicts);

/// Judges a flight by where the aircraft truly was. A pure object.
class Judge {
 public:
  /// The aircraft at one instant.
  struct Sample {
    double time_s = 0;  ///< Of the mission.
    Local position{};
    double height_above_ground_m = 0;
    double ground_speed_m_s = 0;
    double fuel_kg = 0;
    bool on_ground = true;
    bool stalled = false;
  };

  Judge(const PassConditions& conditions, const Local& aim);

  void see(const Sample& sample);

  /// So many elements of interest are to be collected, and have been; `what` says in which way.
  void count(std::size_t collected, std::size_t wanted,
             const std::string& what = "collected as finely as they were ordered");

  /// Another aircraft, at the instant of the last sample.
  void meet(const Local& other);

  /// The probability to have survived until now, and for how long a site that can shoot has
  /// followed the aircraft.
  void suffer(double survival, double tracked_s);

  /// Why it flies home: the cause if not all is collected.
  void flies_home(const std::string& why) { why_home_ = why; }

  /// Whether it has landed, and stands.
  bool standing() const { return stood_s_.has_value(); }
  double duration_s() const { return last_.time_s - took_off_s_.value_or(last_.time_s); }
  bool too_long() const { return duration_s() > conditions_.longest_s; }

  /// The verdict as of now; `ended` says why it is not flown on, if it was not to the end. `more`
  /// are conditions of the targets.
  Verdict conclude(const std::string& ended = "", const std::vector<Check>& more = {}) const;

 private:
  void measure_clearance(const Sample& sample);

  PassConditions conditions_;
  Local aim_;
  std::size_t collected_ = 0;
  std::size_t wanted_ = 0;
  std::string how_collected_ = "collected";
  std::string why_home_;
  /// The least of all: the greater of both distances as a share of what is well clear.
  double separation_ = std::numeric_limits<double>::infinity();
  Local nearest_{};  ///< Of the other from the aircraft, then.
  double survival_ = 1;
  double tracked_s_ = 0;
  Sample last_{};
  std::optional<double> took_off_s_;
  std::optional<double> stood_s_;
  std::optional<Local> touched_;
  double distance_m_ = 0;
  double clearance_m_ = std::numeric_limits<double>::infinity();
  bool stalled_ = false;
};

/// The exit codes of a mission that began. They differ from those of the launcher, which say that a
/// mission was refused, could not start, or lost somebody whom it needs.
inline constexpr int kPassed = 0;
inline constexpr int kFailed = 10;    ///< Flown to its end, and not all conditions are kept.
inline constexpr int kNotFlown = 11;  ///< Not flown to its end.
int exit_code(const Verdict& verdict);

/// As JUnit's XML for build servers: a test case for each check.
std::string to_junit(const Verdict& verdict, const std::string& mission);

}  // namespace reconnaissance
