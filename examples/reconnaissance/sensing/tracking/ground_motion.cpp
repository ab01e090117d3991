#include "sensing/tracking/ground_motion.hpp"

#include <cmath>
#include <numbers>

namespace reconnaissance {
namespace {

using Observation = Eigen::Matrix<double, 2, 4>;

Observation observation() { return Observation::Identity(); }

}  // namespace

TargetMotion moving(double seconds, double acceleration_m_s2) {
  TargetMotion motion{Eigen::Matrix4d::Identity(), Eigen::Matrix4d::Zero()};
  motion.transition.topRightCorner<2, 2>().diagonal().fill(seconds);
  Eigen::Matrix<double, 4, 2> gain = Eigen::Matrix<double, 4, 2>::Zero();
  gain.topRows<2>().diagonal().fill(seconds * seconds / 2);
  gain.bottomRows<2>().diagonal().fill(seconds);
  motion.noise = acceleration_m_s2 * acceleration_m_s2 * gain * gain.transpose();
  return motion;
}

TargetMotion standing(double seconds, double creep_m_s) {
  TargetMotion motion{Eigen::Matrix4d::Zero(), Eigen::Matrix4d::Zero()};
  motion.transition.topLeftCorner<2, 2>().setIdentity();
  const double squared_creep = creep_m_s * creep_m_s;
  motion.noise.diagonal() << squared_creep * seconds * seconds, squared_creep * seconds * seconds,
      squared_creep, squared_creep;
  return motion;
}

GroundEstimate predicted(const GroundEstimate& estimate, const TargetMotion& motion) {
  return {motion.transition * estimate.mean,
          motion.transition * estimate.covariance * motion.transition.transpose() + motion.noise};
}

Innovation innovation(const GroundEstimate& estimate, const GroundDetection& detection) {
  Innovation found;
  found.residual_m = detection.place_m - estimate.place_m();
  found.covariance_m2 = estimate.covariance.topLeftCorner<2, 2>() + detection.covariance_m2;
  found.squared_distance = found.residual_m.dot(found.covariance_m2.inverse() * found.residual_m);
  found.likelihood = std::exp(-found.squared_distance / 2) /
                     (2 * std::numbers::pi * std::sqrt(found.covariance_m2.determinant()));
  return found;
}

GroundEstimate updated(const GroundEstimate& estimate, const GroundDetection& detection) {
  const Innovation found = innovation(estimate, detection);
  const Eigen::Matrix<double, 4, 2> gain =
      estimate.covariance.leftCols<2>() * found.covariance_m2.inverse();
  const Eigen::Matrix4d left = Eigen::Matrix4d::Identity() - gain * observation();
  return {estimate.mean + gain * found.residual_m,
          left * estimate.covariance * left.transpose() +
              gain * detection.covariance_m2 * gain.transpose()};
}

GroundEstimate first_estimate(const GroundDetection& detection, double speed_deviation_m_s) {
  GroundEstimate estimate;
  estimate.mean << detection.place_m, 0, 0;
  estimate.covariance.setZero();
  estimate.covariance.topLeftCorner<2, 2>() = detection.covariance_m2;
  estimate.covariance.bottomRightCorner<2, 2>().diagonal().fill(speed_deviation_m_s *
                                                                speed_deviation_m_s);
  return estimate;
}

}  // namespace reconnaissance
