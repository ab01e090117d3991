#include <algorithm>
#include <catch2/catch.hpp>
#include <limits>
#include <vector>

#include "tracking_scene.hpp"

namespace tracking_filters_test {

using namespace reconnaissance;

namespace {

constexpr int kRuns = 100;
constexpr int kSteps = 60;
constexpr double kStep_s = 1;

Eigen::Matrix2d detection_covariance() {
  Eigen::Matrix2d covariance;
  covariance << 64, 20, 20, 36;
  return covariance;
}

struct Errors {
  std::vector<double> nees = std::vector<double>(kSteps);  ///< At each step, mean over runs.
  double nis = 0;
  double place_m = 0;  ///< Root mean square, second half of the run.
  double speed_m_s = 0;
};

/// `advance(target, step)` moves the target.
template <class Filter>
Errors errors(const TargetAssumptions& truth, const TargetAssumptions& assumed,
              const Eigen::Matrix2d& covariance, auto&& advance) {
  Random random(100);
  Errors all;
  int judged = 0;
  for (int run = 0; run < kRuns; ++run) {
    SimulatedTarget target(random, truth);
    Filter filter(target.detection(covariance), assumed);
    for (int step = 0; step < kSteps; ++step) {
      advance(target, step);
      filter.predict(kStep_s);
      const GroundDetection detection = target.detection(covariance);
      all.nis += filter.squared_distance(detection) / (kRuns * kSteps);
      filter.update(detection);
      all.nees[step] += nees(filter.estimate(), target.state()) / kRuns;
      if (step < kSteps / 2) continue;
      ++judged;
      const GroundState error = filter.estimate().mean - target.state();
      all.place_m += error.head<2>().squaredNorm();
      all.speed_m_s += error.tail<2>().squaredNorm();
    }
  }
  all.place_m = std::sqrt(all.place_m / judged);
  all.speed_m_s = std::sqrt(all.speed_m_s / judged);
  return all;
}

int inside(const Errors& errors, const Bounds& bounds) {
  int count = 0;
  for (const double mean : errors.nees) count += bounds.contain(mean);
  return count;
}

void as_assumed(SimulatedTarget& target, int) { target.move(kStep_s); }

/// Stands for 20 s, drives for 20 s, stands again.
void stop_and_go(SimulatedTarget& target, int step) {
  if (step == 20) target.set_off(8);
  if (step >= 20 && step < 40) {
    target.move(kStep_s);
  } else {
    target.stand(kStep_s);
  }
}

}  // namespace

TEST_CASE("the Kalman filter is consistent: its NEES and NIS lie within the 95 % bounds") {
  const TargetAssumptions assumptions;
  const Errors kalman =
      errors<KalmanTrackFilter>(assumptions, assumptions, detection_covariance(), as_assumed);
  const Bounds bounds(0.95, kRuns, 4);
  // Of 60 steps 57 are expected within; fewer than 51 has a probability below 1 %, were the steps
  // independent.
  CHECK(inside(kalman, bounds) >= 51);
  CHECK(Bounds(0.95, kRuns * kSteps, 2).contain(kalman.nis));
}

TEST_CASE("of a target that stops and goes, the filter that knows so is the most exact") {
  const TargetAssumptions assumptions;
  const Eigen::Matrix2d round = 49 * Eigen::Matrix2d::Identity();
  const Errors kalman = errors<KalmanTrackFilter>(assumptions, assumptions, round, stop_and_go);
  const Errors both = errors<StopMoveTrackFilter>(assumptions, assumptions, round, stop_and_go);
  CHECK(both.place_m < 0.9 * kalman.place_m);
  CHECK(both.speed_m_s < 0.9 * kalman.speed_m_s);
}

TEST_CASE("without changes of mode the stop-move filter weighs two Kalman filters by Bayes' rule") {
  TargetAssumptions assumptions;
  assumptions.mean_time_standing_s = std::numeric_limits<double>::infinity();
  assumptions.mean_time_moving_s = std::numeric_limits<double>::infinity();
  Random random(8);
  SimulatedTarget target(random, {.speed_deviation_m_s = 0.3});
  const Eigen::Matrix2d covariance = detection_covariance();
  const GroundDetection first = target.detection(covariance);
  StopMoveTrackFilter filter(first, assumptions);
  GroundEstimate stands = first_estimate(first, assumptions.creep_m_s);
  GroundEstimate moves = first_estimate(first, assumptions.speed_deviation_m_s);
  double odds = 1;
  for (int step = 0; step < 8; ++step) {
    target.move(kStep_s);
    const GroundDetection detection = target.detection(covariance);
    filter.predict(kStep_s);
    filter.update(detection);
    stands = predicted(stands, standing(kStep_s, assumptions.creep_m_s));
    moves = predicted(moves, moving(kStep_s, assumptions.acceleration_m_s2));
    odds *= innovation(stands, detection).likelihood / innovation(moves, detection).likelihood;
    stands = updated(stands, detection);
    moves = updated(moves, detection);
    REQUIRE(filter.probability_of_standing() == Approx(odds / (1 + odds)));
    const double p = odds / (1 + odds);
    REQUIRE(filter.estimate().mean.isApprox(p * stands.mean + (1 - p) * moves.mean, 1e-9));
  }
}

TEST_CASE("the stop-move filter says within seconds that a target has stopped or moved off") {
  Random random(9);
  const TargetAssumptions assumptions;
  SimulatedTarget target(random, assumptions);
  const Eigen::Matrix2d covariance = 49 * Eigen::Matrix2d::Identity();
  StopMoveTrackFilter filter(target.detection(covariance), assumptions);
  double stands = 0;
  double moves = 0;
  for (int step = 0; step < kSteps; ++step) {
    stop_and_go(target, step);
    filter.predict(kStep_s);
    filter.update(target.detection(covariance));
    if (step == 19 || step == 55) stands += filter.probability_of_standing() / 2;
    if (step == 30) moves = 1 - filter.probability_of_standing();
  }
  CHECK(stands > 0.9);
  CHECK(moves > 0.99);
}

TEST_CASE(
    "the stop-move filter is not overconfident about a target that changes its mode by chance") {
  const TargetAssumptions assumptions;
  Random modes(21);
  bool stands = true;
  const auto by_chance = [&](SimulatedTarget& target, int step) {
    if (step == 0) stands = true;
    const double mean_s =
        stands ? assumptions.mean_time_standing_s : assumptions.mean_time_moving_s;
    if (modes.happens(1 - std::exp(-kStep_s / mean_s))) stands = !stands;
    if (stands) {
      target.stand(kStep_s);
    } else {
      target.move(kStep_s);
    }
  };
  const Errors both =
      errors<StopMoveTrackFilter>(assumptions, assumptions, detection_covariance(), by_chance);
  double mean = 0;
  for (const double one : both.nees) mean += one / kSteps;
  CHECK(mean < 4.4);
  CHECK(both.nis == Approx(2).epsilon(0.1));
}

}  // namespace tracking_filters_test
