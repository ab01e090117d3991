#include <catch2/catch.hpp>
#include <vector>

#include "sensing/tracking/track_fusion.hpp"
#include "tracking_scene.hpp"

namespace tracking_fusion_test {

using namespace reconnaissance;

namespace {

constexpr int kRuns = 400;
constexpr int kSteps = 40;

bool everywhere(const Eigen::Vector2d&) { return true; }

/// The mean NEES of what is fused, over the runs and at the last step, as a share of the most that
/// chance allows.
template <class One, class Other>
double share_of_bound(bool two_cameras, auto&& advance) {
  Random random(41);
  const TargetAssumptions assumptions;
  // A gate that is seldom passed by a target's own detection: rejections are not the subject.
  const TrackerRules rules{.gate_probability = 0.9999};
  const Eigen::Matrix2d covariance = 49 * Eigen::Matrix2d::Identity();
  int runs = 0;
  double sum = 0;
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
    ++runs;
    sum += nees(fused[0].estimate, target.state());
  }
  REQUIRE(runs > 380);
  return sum / runs / Bounds(0.95, runs, 4).high;
}

Track track_at(std::uint32_t number, double north_m, double east_m) {
  return {number, first_estimate({{north_m, east_m}, 25 * Eigen::Matrix2d::Identity()}, 5), 3,
          static_cast<double>(number)};
}

}  // namespace

TEST_CASE("tracks of two cameras are fused consistently") {
  // What they have in common is the target's motion, which neither knows (Bar-Shalom and Campo
  // 1986).
  CHECK(share_of_bound<KalmanTrackFilter, KalmanTrackFilter>(
            true, [](SimulatedTarget& target, int) { target.move(1); }) < 1);
}

TEST_CASE("tracks by other filters of one camera's detections are fused nearly consistently") {
  Random modes(42);
  bool stands = false;
  const auto stop_and_go = [&](SimulatedTarget& target, int step) {
    const TargetAssumptions assumptions;
    if (step == 1) stands = modes.happens(0.5);
    const double mean_s =
        stands ? assumptions.mean_time_standing_s : assumptions.mean_time_moving_s;
    if (modes.happens(1 - std::exp(-1 / mean_s))) stands = !stands;
    stands ? target.stand(1) : target.move(1);
  };
  // The errors are not Gaussian, so that the intersection is beyond the bounds by little.
  CHECK(share_of_bound<KalmanTrackFilter, StopMoveTrackFilter>(false, stop_and_go) < 1.2);
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
