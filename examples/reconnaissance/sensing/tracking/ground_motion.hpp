#pragma once

#include <Eigen/Dense>

namespace reconnaissance {

/// North and east in metres, then their rates in m/s.
using GroundState = Eigen::Vector4d;

/// Where something on the ground was seen: an unbiased place and the covariance of its error.
struct GroundDetection {
  Eigen::Vector2d place_m;
  Eigen::Matrix2d covariance_m2;
};

/// An estimate of a ground target's state and the covariance of its error.
struct GroundEstimate {
  GroundState mean = GroundState::Zero();
  Eigen::Matrix4d covariance = Eigen::Matrix4d::Identity();

  Eigen::Vector2d place_m() const { return mean.head<2>(); }
};

/// How a state continues: x' = F x + w, w of covariance Q.
struct TargetMotion {
  Eigen::Matrix4d transition;
  Eigen::Matrix4d noise;
};

/// Constant velocity, disturbed by an acceleration that is constant over the step and independent
/// from step to step: Q = σ² g gᵀ per axis with g = (T²/2, T) (Bar-Shalom, Li and Kirubarajan,
/// "Estimation with Applications to Tracking and Navigation", 2001, 6.3.2).
TargetMotion moving(double seconds, double acceleration_m_s2);

/// Stands still: the velocity is 0 but for a creep, which moves the place as well.
TargetMotion standing(double seconds, double creep_m_s);

GroundEstimate predicted(const GroundEstimate& estimate, const TargetMotion& motion);

/// What a detection says about an estimate, before it is used.
struct Innovation {
  Eigen::Vector2d residual_m;
  Eigen::Matrix2d covariance_m2;
  double squared_distance = 0;  ///< Normalised (NIS): chi-square, 2 degrees of freedom.
  double likelihood = 0;        ///< Density of the residual, 1/m².
};

Innovation innovation(const GroundEstimate& estimate, const GroundDetection& detection);

/// Kalman update; the covariance in Joseph's form, which stays symmetric and positive definite.
GroundEstimate updated(const GroundEstimate& estimate, const GroundDetection& detection);

/// Of a target that was seen once: its place, and any velocity of that standard deviation.
GroundEstimate first_estimate(const GroundDetection& detection, double speed_deviation_m_s);

}  // namespace reconnaissance
