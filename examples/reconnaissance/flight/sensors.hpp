#pragma once

#include <array>
#include <optional>

#include "point_mass.hpp"
#include "random.hpp"

namespace reconnaissance {

/// What one of an aircraft's redundant sets of sensors measures.
struct Measurement {
  Local position{};  ///< By satellite.
  double north_m_s = 0;
  double east_m_s = 0;
  double up_m_s = 0;
  double airspeed_m_s = 0;  ///< By air data.
  double heading_rad = 0;   ///< By gyroscopes, as are the following.
  double climb_rad = 0;
  double bank_rad = 0;
};

/// Standard deviations of a set's errors. Those of the position wander (a first-order Gauss-Markov
/// process); the others are white. Satellite: the accuracy that the GPS performance standard (2020)
/// promises, 8 m horizontally in 95 %, is some 3.3 m on each axis; the other figures are those of
/// common small air data and attitude sensors.
struct SensorNoise {
  double level_m = 3.3;
  double height_m = 5;
  double wander_time_s = 100;
  double velocity_m_s = 0.1;
  double airspeed_m_s = 0.5;
  double angle_rad = 0.005;
};

/// One of the sets.
class SensorModel {
 public:
  explicit SensorModel(const SensorNoise& noise = {}) : noise_(noise) {}

  /// What it measures, `seconds` after the measurement before.
  Measurement measure(const Aircraft& aircraft, double seconds, Random& random);

 private:
  SensorNoise noise_;
  Local error_{};
  bool settled_ = false;
};

/// The mid value of what three sensors measure: one that lies, however much, does not count. Of two
/// the mean, of one its value; nothing of none.
std::optional<double> mid_value(const std::array<std::optional<double>, 3>& values);

/// The same of angles, which must lie within a half turn of each other; 0 to 2 pi.
std::optional<double> mid_angle_rad(const std::array<std::optional<double>, 3>& angles);

/// The mid value of each quantity for itself; nothing where no set measures.
std::optional<Measurement> mid_measurement(
    const std::array<std::optional<Measurement>, 3>& measurements);

/// How much a set may differ from the mid value in position, height, speed, and angle, and for how
/// long, before it is voted out, and for how long it must agree before it is heard again.
struct VotingLimits {
  double level_m = 40;
  double height_m = 40;
  double velocity_m_s = 5;
  double airspeed_m_s = 8;
  double angle_rad = 0.15;
  double out_after_s = 1;
  double back_after_s = 5;
};

/// Votes among three sets: who disagrees for long, or is silent, is left out of the mid value until
/// it has agreed for long.
class Voter {
 public:
  explicit Voter(const VotingLimits& limits = {}) : limits_(limits) {}

  /// The measurement that stands, `seconds` after the one before: of the sets that are heard, or,
  /// if none of them measures, of all that do; nothing if none does.
  std::optional<Measurement> vote(const std::array<std::optional<Measurement>, 3>& measurements,
                                  double seconds);

  /// Whether the set is voted out.
  bool out(std::size_t set) const { return sets_[set].out; }

 private:
  struct Set {
    bool out = false;
    double for_s = 0;  ///< How long it has spoken against its standing.
  };

  VotingLimits limits_;
  std::array<Set, 3> sets_{};
};

}  // namespace reconnaissance
