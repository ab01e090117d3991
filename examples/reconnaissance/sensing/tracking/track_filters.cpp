#include "sensing/tracking/track_filters.hpp"

#include <algorithm>
#include <cmath>

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
