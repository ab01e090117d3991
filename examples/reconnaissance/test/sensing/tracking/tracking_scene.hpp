#pragma once

#include <boost/math/distributions/chi_squared.hpp>
#include <cmath>

#include "random.hpp"
#include "sensing/tracking/track_filters.hpp"

// What tests of tracking share: a target that moves as the filters assume, and how a sum of
// normalised errors is judged.
namespace reconnaissance {

inline Eigen::Vector2d normal_pair(Random& random) {
  const double north = random.normal();
  return {north, random.normal()};
}

/// A target and its detections, with the errors that their covariance says.
class SimulatedTarget {
 public:
  SimulatedTarget(Random& random, const TargetAssumptions& assumptions)
      : random_(random), assumptions_(assumptions) {
    state_ << 3000 * normal_pair(random), assumptions.speed_deviation_m_s * normal_pair(random);
  }

  /// The acceleration is constant over the step.
  void move(double seconds) {
    const Eigen::Vector2d acceleration = assumptions_.acceleration_m_s2 * normal_pair(random_);
    state_.head<2>() += seconds * state_.tail<2>() + seconds * seconds / 2 * acceleration;
    state_.tail<2>() += seconds * acceleration;
  }
  void stand(double seconds) {
    state_.tail<2>() = assumptions_.creep_m_s * normal_pair(random_);
    state_.head<2>() += assumptions_.creep_m_s * seconds * normal_pair(random_);
  }
  void set_off(double speed_m_s) { state_.tail<2>() << speed_m_s, speed_m_s / 2; }

  GroundDetection detection(const Eigen::Matrix2d& covariance) {
    const Eigen::Matrix2d root = covariance.llt().matrixL();
    return {state_.head<2>() + root * normal_pair(random_), covariance};
  }

  const GroundState& state() const { return state_; }

 private:
  Random& random_;
  TargetAssumptions assumptions_;
  GroundState state_;
};

inline double nees(const GroundEstimate& estimate, const GroundState& truth) {
  const GroundState error = estimate.mean - truth;
  return error.dot(estimate.covariance.inverse() * error);
}

/// The mean of so many chi-square variables lies within these with that probability.
struct Bounds {
  Bounds(double probability, int count, int degrees_of_freedom) {
    const boost::math::chi_squared sum(static_cast<double>(count) * degrees_of_freedom);
    low = boost::math::quantile(sum, (1 - probability) / 2) / count;
    high = boost::math::quantile(sum, (1 + probability) / 2) / count;
  }
  bool contain(double mean) const { return low <= mean && mean <= high; }
  double low, high;
};

}  // namespace reconnaissance
