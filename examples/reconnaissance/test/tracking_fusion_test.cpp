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

/// Whether the mean NEES of what is fused, over the runs and at the last step, is no greater than
/// chance allows.
template <class One, class Other>
bool is_consistent(bool two_cameras) {
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
      if (step > 0) target.move(1);
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
  return sum / runs < Bounds(0.95, runs, 4).high;
}

Track track_at(std::uint32_t number, double north_m, double east_m) {
  return {number, first_estimate({{north_m, east_m}, 25 * Eigen::Matrix2d::Identity()}, 5), 3,
          static_cast<double>(number)};
}

}  // namespace

TEST_CASE("two trackers of one camera, or of two cameras, are fused consistently") {
  // The same detections, other filters.
  CHECK(is_consistent<KalmanTrackFilter, StopMoveTrackFilter>(false));
  // What they have in common is the target's motion, which neither knows (Bar-Shalom and Campo
  // 1986).
  CHECK(is_consistent<KalmanTrackFilter, KalmanTrackFilter>(true));
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
