#pragma once

#include <array>

#include "sensing/tracking/ground_motion.hpp"

namespace reconnaissance {

/// What is assumed of ground targets. Vehicles on roads and tracks.
struct TargetAssumptions {
  double acceleration_m_s2 = 0.5;    ///< Of a moving one, standard deviation of each step's.
  double creep_m_s = 0.05;           ///< Of a standing one.
  double speed_deviation_m_s = 10;   ///< Before anything is known, on each axis.
  double mean_time_standing_s = 60;  ///< Before it moves off.
  double mean_time_moving_s = 120;   ///< Before it stops.
};

// Two filters with the same functions, for Tracker<Filter>. Each begins with a detection;
// predict() moves it on in time, update() uses a detection of that time.

/// Kalman filter for constant velocity.
class KalmanTrackFilter {
 public:
  KalmanTrackFilter(const GroundDetection& first, const TargetAssumptions& assumptions = {})
      : assumptions_(assumptions),
        estimate_(first_estimate(first, assumptions.speed_deviation_m_s)) {}

  void predict(double seconds);
  double squared_distance(const GroundDetection& detection) const;
  void update(const GroundDetection& detection);
  const GroundEstimate& estimate() const { return estimate_; }

 private:
  TargetAssumptions assumptions_;
  GroundEstimate estimate_;
};

/// Interacting multiple models, standing and moving (Blom and Bar-Shalom 1988): two Kalman filters
/// whose estimates are mixed before each step by the probability that the target has changed its
/// mode, exp(−T / mean time) to keep it.
class StopMoveTrackFilter {
 public:
  static constexpr int kStanding = 0;
  static constexpr int kMoving = 1;

  StopMoveTrackFilter(const GroundDetection& first, const TargetAssumptions& assumptions = {});

  void predict(double seconds);
  double squared_distance(const GroundDetection& detection) const;
  void update(const GroundDetection& detection);

  /// Mean and covariance of the mixture.
  const GroundEstimate& estimate() const { return combined_; }
  double probability_of_standing() const { return probability_[kStanding]; }

 private:
  void combine();

  TargetAssumptions assumptions_;
  std::array<GroundEstimate, 2> models_;
  std::array<double, 2> probability_{0.5, 0.5};
  GroundEstimate combined_;
};

}  // namespace reconnaissance
