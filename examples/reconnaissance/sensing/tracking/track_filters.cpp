#include "sensing/tracking/track_filters.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace reconnaissance {
namespace {

GroundEstimate mixture(const std::array<GroundEstimate, 2>& estimates,
                       const std::array<double, 2>& weights) {
  GroundEstimate mixed;
  mixed.mean = weights[0] * estimates[0].mean + weights[1] * estimates[1].mean;
  mixed.covariance.setZero();
  for (std::size_t i = 0; i < 2; ++i) {
    const GroundState apart = estimates[i].mean - mixed.mean;
    mixed.covariance += weights[i] * (estimates[i].covariance + apart * apart.transpose());
  }
  return mixed;
}

}  // namespace

void KalmanTrackFilter::predict(double seconds) {
  estimate_ = predicted(estimate_, moving(seconds, assumptions_.acceleration_m_s2));
}

double KalmanTrackFilter::squared_distance(const GroundDetection& detection) const {
  return innovation(estimate_, detection).squared_distance;
}

void KalmanTrackFilter::update(const GroundDetection& detection) {
  estimate_ = updated(estimate_, detection);
}

SteadyGains steady_gains(double tracking_index) {
  const double lambda = tracking_index;
  const double root = std::sqrt(lambda * lambda + 8 * lambda);
  return {-(lambda * lambda + 8 * lambda - (lambda + 4) * root) / 8,
          (lambda * lambda + 4 * lambda - lambda * root) / 4};
}

AlphaBetaTrackFilter::AlphaBetaTrackFilter(const GroundDetection& first,
                                           const TargetAssumptions& assumptions)
    : assumptions_(assumptions),
      estimate_(first_estimate(first, assumptions.speed_deviation_m_s)) {}

void AlphaBetaTrackFilter::predict(double seconds) {
  estimate_ = predicted(estimate_, moving(seconds, assumptions_.acceleration_m_s2));
  since_update_s_ += seconds;
}

double AlphaBetaTrackFilter::squared_distance(const GroundDetection& detection) const {
  return innovation(estimate_, detection).squared_distance;
}

void AlphaBetaTrackFilter::update(const GroundDetection& detection) {
  if (since_update_s_ <= 0) return;
  const double step_s = std::exchange(since_update_s_, 0);
  const double k = ++detections_;
  const double variance = detection.covariance_m2.trace() / 2;
  SteadyGains gains =
      steady_gains(assumptions_.acceleration_m_s2 * step_s * step_s / std::sqrt(variance));
  // 6.5.3 there: of a settled filter, after an update.
  double squared_speed = gains.beta * (gains.alpha - gains.beta / 2) / (1 - gains.alpha);
  if (const double alpha = 2 * (2 * k - 1) / (k * (k + 1)); alpha > gains.alpha) {
    gains = {alpha, 6 / (k * (k + 1))};
    squared_speed = 12 / (k * (k * k - 1));
  }
  const Eigen::Vector2d residual = detection.place_m - estimate_.place_m();
  estimate_.mean.head<2>() += gains.alpha * residual;
  estimate_.mean.tail<2>() += gains.beta / step_s * residual;
  const double place = gains.alpha * variance;
  const double both = gains.beta * variance / step_s;
  const double speed = squared_speed * variance / (step_s * step_s);
  estimate_.covariance.setZero();
  estimate_.covariance.topLeftCorner<2, 2>().diagonal().fill(place);
  estimate_.covariance.topRightCorner<2, 2>().diagonal().fill(both);
  estimate_.covariance.bottomLeftCorner<2, 2>().diagonal().fill(both);
  estimate_.covariance.bottomRightCorner<2, 2>().diagonal().fill(speed);
}

StopMoveTrackFilter::StopMoveTrackFilter(const GroundDetection& first,
                                         const TargetAssumptions& assumptions)
    : assumptions_(assumptions) {
  models_[kStanding] = first_estimate(first, assumptions.creep_m_s);
  models_[kMoving] = first_estimate(first, assumptions.speed_deviation_m_s);
  combine();
}

void StopMoveTrackFilter::predict(double seconds) {
  const std::array<double, 2> keep{std::exp(-seconds / assumptions_.mean_time_standing_s),
                                   std::exp(-seconds / assumptions_.mean_time_moving_s)};
  const std::array<TargetMotion, 2> motions{standing(seconds, assumptions_.creep_m_s),
                                            moving(seconds, assumptions_.acceleration_m_s2)};
  std::array<GroundEstimate, 2> next;
  std::array<double, 2> next_probability;
  for (std::size_t to = 0; to < 2; ++to) {
    std::array<double, 2> weights;
    for (std::size_t from = 0; from < 2; ++from) {
      weights[from] = probability_[from] * (from == to ? keep[from] : 1 - keep[from]);
    }
    next_probability[to] = weights[0] + weights[1];
    for (double& weight : weights) weight /= next_probability[to];
    next[to] = predicted(mixture(models_, weights), motions[to]);
  }
  models_ = next;
  probability_ = next_probability;
  combine();
}

double StopMoveTrackFilter::squared_distance(const GroundDetection& detection) const {
  return innovation(combined_, detection).squared_distance;
}

void StopMoveTrackFilter::update(const GroundDetection& detection) {
  // A model that is excluded keeps a probability that it can come back from.
  constexpr double kLeastProbability = 1e-9;
  double sum = 0;
  for (std::size_t i = 0; i < 2; ++i) {
    probability_[i] *= innovation(models_[i], detection).likelihood;
    models_[i] = updated(models_[i], detection);
    sum += probability_[i];
  }
  for (double& one : probability_) {
    one = sum > 0 ? std::clamp(one / sum, kLeastProbability, 1 - kLeastProbability) : 0.5;
  }
  combine();
}

void StopMoveTrackFilter::combine() { combined_ = mixture(models_, probability_); }

}  // namespace reconnaissance
