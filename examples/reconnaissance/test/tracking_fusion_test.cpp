#include <catch2/catch.hpp>
#include <skein/fusion.hpp>
#include <vector>

#include "sensing/tracking/track_fusion.hpp"
#include "tracking_scene.hpp"

namespace tracking_fusion_test {

using namespace reconnaissance;

namespace {

constexpr int kRuns = 400;
constexpr int kSteps = 40;

bool everywhere(const Eigen::Vector2d&) { return true; }

Track naively_fused(const Track& a, const Track& b) {
  // As if their errors were independent.
  const Eigen::Matrix4d one = a.estimate.covariance.inverse();
  const Eigen::Matrix4d two = b.estimate.covariance.inverse();
  Track fused = a;
  fused.estimate.covariance = (one + two).inverse();
  fused.estimate.mean = fused.estimate.covariance * (one * a.estimate.mean + two * b.estimate.mean);
  return fused;
}

/// Means over the runs, at the last step.
struct Nees {
  int runs = 0;
  double one = 0, other = 0, naive = 0, intersected = 0;
  Bounds bounds() const { return {0.95, runs, 4}; }
};

template <class One, class Other>
Nees fly(bool two_cameras, auto&& advance) {
  Random random(41);
  const TargetAssumptions assumptions;
  // A gate that is seldom passed by a target's own detection: rejections are not the subject.
  const TrackerRules rules{.gate_probability = 0.9999};
  const Eigen::Matrix2d covariance = 49 * Eigen::Matrix2d::Identity();
  Nees all;
  for (int run = 0; run < kRuns; ++run) {
    SimulatedTarget target(random, assumptions);
    Tracker<One> first(assumptions, rules);
    Tracker<Other> second(assumptions, rules);
    for (int step = 0; step < kSteps; ++step) {
      if (step > 0) advance(target, step);
      const std::vector detections{target.detection(covariance)};
      first.look(step, detections, everywhere);
      second.look(step, two_cameras ? std::vector{target.detection(covariance)} : detections,
                  everywhere);
    }
    const auto one = first.tracks();
    const auto other = second.tracks();
    if (one.size() != 1 || other.size() != 1) continue;
    const auto fused = fuse_tracks(one, other, 0.9999);
    if (fused.size() != 1) continue;
    ++all.runs;
    all.one += nees(one[0].estimate, target.state());
    all.other += nees(other[0].estimate, target.state());
    all.naive += nees(naively_fused(one[0], other[0]).estimate, target.state());
    all.intersected += nees(fused[0].estimate, target.state());
  }
  REQUIRE(all.runs > 380);
  for (double* sum : {&all.one, &all.other, &all.naive, &all.intersected}) *sum /= all.runs;
  WARN("mean NEES of " << all.runs << " runs, bounds " << all.bounds().low << " to "
                       << all.bounds().high << ": trackers " << all.one << " and " << all.other
                       << ", intersection " << all.intersected << ", as if independent "
                       << all.naive);
  return all;
}

void moves(SimulatedTarget& target, int) { target.move(1); }

Track track_at(std::uint32_t number, double north_m, double east_m) {
  return {number, first_estimate({{north_m, east_m}, 25 * Eigen::Matrix2d::Identity()}, 5), 3,
          static_cast<double>(number)};
}

}  // namespace

TEST_CASE(
    "two trackers of one camera fused by intersection are consistent, naively overconfident") {
  // The same detections, other filters.
  const Nees nees = fly<KalmanTrackFilter, StopMoveTrackFilter>(false, moves);
  CHECK(nees.naive > nees.bounds().high);
  CHECK(nees.intersected < nees.bounds().high);
}

TEST_CASE(
    "two trackers of two cameras fused by intersection are consistent, naively overconfident") {
  // What they have in common is the target's motion, which neither knows (Bar-Shalom and Campo
  // 1986).
  const Nees nees = fly<KalmanTrackFilter, KalmanTrackFilter>(true, moves);
  CHECK(nees.naive > nees.bounds().high);
  CHECK(nees.intersected < nees.bounds().high);
}

TEST_CASE(
    "of a target that stops and goes, naive fusion with the stop-move filter is the more "
    "overconfident") {
  Random modes(42);
  bool stands = false;
  const Nees nees =
      fly<KalmanTrackFilter, StopMoveTrackFilter>(false, [&](SimulatedTarget& target, int step) {
        const TargetAssumptions assumptions;
        if (step == 1) stands = modes.happens(0.5);
        const double mean_s =
            stands ? assumptions.mean_time_standing_s : assumptions.mean_time_moving_s;
        if (modes.happens(1 - std::exp(-1 / mean_s))) stands = !stands;
        stands ? target.stand(1) : target.move(1);
      });
  // The errors are not Gaussian, so that the intersection is beyond the bounds by little.
  CHECK(nees.naive > 1.5 * nees.bounds().high);
  CHECK(nees.intersected < 1.2 * nees.bounds().high);
}

TEST_CASE("the intersection of tracks gives the figures of MATLAB's example of fusecovint") {
  // x₁ = (1, 2, 0), P₁ = [10 5 0; 5 10 0; 0 0 1], x₂ = (2, 2, 0), P₂ with −5: by symmetry ω = 0.5,
  // P = diag(7.5, 7.5, 1), x = (1.5, 2.25, 0). Here with a fourth component like the third.
  Track one = track_at(1, 0, 0);
  one.estimate.mean << 1, 2, 0, 0;
  one.estimate.covariance << 10, 5, 0, 0, 5, 10, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1;
  Track two = track_at(2, 0, 0);
  two.estimate.mean << 2, 2, 0, 0;
  two.estimate.covariance << 10, -5, 0, 0, -5, 10, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1;
  const auto fused = fuse_tracks({one}, {two});
  REQUIRE(fused.size() == 1);
  Eigen::Vector4d mean;
  mean << 1.5, 2.25, 0, 0;
  CHECK((fused[0].estimate.mean - mean).norm() < 1e-4);
  Eigen::Vector4d diagonal;
  diagonal << 7.5, 7.5, 1, 1;
  CHECK((fused[0].estimate.covariance - Eigen::Matrix4d(diagonal.asDiagonal())).norm() < 1e-2);
}

TEST_CASE("tracks of different targets stay apart, and those of one tracker alone are kept") {
  const std::vector first{track_at(1, 0, 0), track_at(2, 1000, 0)};
  const std::vector second{track_at(1, 1003, 0), track_at(2, 0, 3), track_at(3, 0, 2000)};
  const auto fused = fuse_tracks(first, second);
  REQUIRE(fused.size() == 3);
  CHECK(fused[0].number == 1);
  CHECK(fused[0].estimate.mean(1) == Approx(1.5));
  CHECK(fused[1].number == 2);
  CHECK(fused[1].estimate.mean(0) == Approx(1001.5));
  CHECK(fused[1].seen_s == 2);
  CHECK(fused[2].number == kSecondTracker + 3);
  CHECK(fused[2].estimate.mean == second[2].estimate.mean);
}

TEST_CASE("no tracks fuse to none") {
  CHECK(fuse_tracks({}, {}).empty());
  CHECK(fuse_tracks({track_at(1, 0, 0)}, {}).size() == 1);
}

}  // namespace tracking_fusion_test
