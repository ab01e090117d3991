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

// Three filters with the same functions, for Tracker<Filter>. Each begins with a detection;
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

/// Gains of a Kalman filter that has settled on one axis: place and velocity (α, β/T).
struct SteadyGains {
  double alpha = 1;
  double beta = 0;
};

/// For a tracking index λ = σ_acceleration T² / σ_detection (Kalata 1984; Bar-Shalom, Li and
/// Kirubarajan 2001, 6.5.3).
SteadyGains steady_gains(double tracking_index);

/// α-β filter: those gains, as if all detections came at one rate and with one error, that of the
/// latest step and detection. Until it has settled it has the gains of a straight line that is
/// fitted to all k detections by least squares, α = 2 (2k − 1) / (k (k + 1)) and β = 6 / (k (k +
/// 1)). Its covariance is that of the line or of the settled filter; cheap, and overconfident for
/// some steps where one becomes the other. A detection at the time of the last is not used.
class AlphaBetaTrackFilter {
 public:
  AlphaBetaTrackFilter(const GroundDetection& first, const TargetAssumptions& assumptions = {});

  void predict(double seconds);
  double squared_distance(const GroundDetection& detection) const;
  void update(const GroundDetection& detection);
  const GroundEstimate& estimate() const { return estimate_; }

 private:
  TargetAssumptions assumptions_;
  GroundEstimate estimate_;
  double since_update_s_ = 0;
  int detections_ = 1;
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
