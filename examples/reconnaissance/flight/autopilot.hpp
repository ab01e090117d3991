#pragma once

#include <optional>

#include "point_mass.hpp"

namespace reconnaissance {

/// How a rigid aircraft moves, as its autopilot sees it. Angles and rates in radians, positive to
/// the right and upwards.
struct Motions {
  double airspeed_m_s = 0;
  double climb_rad = 0;  ///< Of its motion through the air.
  double bank_rad = 0;
  double pitch_rad = 0;
  double nose_rad = 0;  ///< Where it points.
  double roll_rate = 0;
  double pitch_rate = 0;
  double yaw_rate = 0;
  double track_rad = 0;  ///< Over ground.
  double ground_m_s = 0;
  bool on_ground = true;
};

/// Shares of what each can give: surfaces from -1 to 1 (right wing down, nose up, nose right), the
/// rest from 0 to 1.
struct Controls {
  double aileron = 0;
  double elevator = 0;
  double rudder = 0;  ///< And the nose wheel.
  double throttle = 0;
  double brakes = 0;
};

/// Flies a small rigid aircraft by the demands that a point mass takes: bank, climb and speed, each
/// a loop of its own about the rates. It holds the course on the runway, rotates when a climb is
/// demanded, and brakes when no speed is. Gains are those of jsbsim/tactical_uav.xml; those of
/// surfaces fall with the square of the airspeed, as surfaces gain. A pure object.
class Autopilot {
 public:
  /// As in trimmed flight at that speed, whatever was before.
  void begin();

  /// What is to be done for the next `seconds`. Demands beyond the airframe's limits are cut.
  Controls fly(const Airframe& airframe, const Demand& demand, const Motions& motions,
               double seconds);

 private:
  Controls roll(const Demand& demand, const Motions& motions, double seconds);
  double aileron(double bank_rad, const Motions& motions, double greatest_rate, double seconds);
  double elevator(double climb_rad, const Motions& motions, double seconds);
  double throttle(double airspeed_m_s, double climb_rad, const Motions& motions, double seconds);

  // What each loop has learned.
  double bank_trim_ = 0;
  double pitch_trim_ = 0;
  double speed_trim_ = 0;
  std::optional<double> runway_rad_;  // the course that is held on the ground
  double aside_m_ = 0;                // to the right of where that began
};

}  // namespace reconnaissance
