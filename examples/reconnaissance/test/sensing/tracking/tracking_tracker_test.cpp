#include <catch2/catch.hpp>
#include <vector>

#include "sensing/tracking/tracker.hpp"
#include "tracking_scene.hpp"

namespace tracking_tracker_test {

using namespace reconnaissance;

namespace {

const Eigen::Matrix2d kCovariance = 25 * Eigen::Matrix2d::Identity();

GroundDetection at(double north_m, double east_m) { return {{north_m, east_m}, kCovariance}; }

bool everywhere(const Eigen::Vector2d&) { return true; }
bool nowhere(const Eigen::Vector2d&) { return false; }

using KalmanTracker = Tracker<KalmanTrackFilter>;

}  // namespace

TEST_CASE("a track is confirmed by three detections in five looks") {
  KalmanTracker tracker;
  const std::vector<GroundDetection> seen{at(100, 100)};
  struct Look {
    bool detected;
    std::size_t tracks;
  };
  double now_s = 0;
  for (const auto& [detected, tracks] :
       {Look{true, 0}, Look{false, 0}, Look{true, 0}, Look{false, 0}, Look{true, 1}}) {
    tracker.look(now_s++, detected ? seen : std::vector<GroundDetection>{}, everywhere);
    CHECK(tracker.tracks().size() == tracks);
  }
  CHECK(tracker.tracks()[0].number == 1);
  CHECK(tracker.tracks()[0].detections == 3);
  CHECK(tracker.tracks()[0].seen_s == 4);
}

TEST_CASE("what is detected twice in five looks becomes no track") {
  KalmanTracker tracker;
  const std::vector<GroundDetection> seen{at(100, 100)};
  for (const bool detected : {true, true, false, false, false, true, true, false, false, false}) {
    static double now_s = 0;
    tracker.look(now_s++, detected ? seen : std::vector<GroundDetection>{}, everywhere);
    CHECK(tracker.tracks().empty());
  }
}

TEST_CASE("a track ends after five looks in a row that miss it, not while nobody looks there") {
  KalmanTracker tracker;
  double now_s = 0;
  for (int i = 0; i < 4; ++i) tracker.look(now_s++, {at(100, 100)}, everywhere);
  for (int i = 0; i < 20; ++i) tracker.look(now_s++, {}, nowhere);
  REQUIRE(tracker.tracks().size() == 1);
  CHECK(tracker.tracks()[0].seen_s == 3);
  for (int i = 0; i < 4; ++i) tracker.look(now_s++, {}, everywhere);
  REQUIRE(tracker.tracks().size() == 1);
  tracker.look(now_s++, {}, everywhere);
  CHECK(tracker.tracks().empty());
}

TEST_CASE("a track that nobody sees ends when its place is no longer known") {
  KalmanTracker tracker;
  double now_s = 0;
  for (int i = 0; i < 4; ++i) tracker.look(now_s++, {at(100, 100)}, everywhere);
  while (!tracker.tracks().empty() && now_s < 600) tracker.look(now_s++, {}, nowhere);
  // σ² T³ / 3 of the acceleration's deviation 0.5 m/s² becomes 500² m² after some 140 s.
  CHECK(now_s > 60);
  CHECK(now_s < 200);
}

TEST_CASE("a detection outside the gate does not move a track") {
  KalmanTracker tracker;
  double now_s = 0;
  for (int i = 0; i < 10; ++i) tracker.look(now_s++, {at(100, 100)}, everywhere);
  const GroundEstimate before = tracker.tracks()[0].estimate;
  tracker.look(now_s++, {at(100, 140)}, everywhere);
  CHECK((tracker.tracks()[0].estimate.place_m() - before.place_m()).norm() < 5);
  CHECK(tracker.tracks()[0].detections == 10);
}

TEST_CASE("the gate ends at the chi-square quantile of its probability") {
  // Quantiles for 2 degrees of freedom from published tables.
  struct Row {
    double probability, quantile;
  };
  for (const auto& [probability, quantile] :
       {Row{0.9, 4.605}, Row{0.95, 5.991}, Row{0.99, 9.210}}) {
    for (const bool inside : {true, false}) {
      TrackerRules rules;
      rules.gate_probability = probability;
      KalmanTracker tracker({}, rules);
      for (int i = 0; i < 10; ++i) tracker.look(i, {at(0, 0)}, everywhere);
      const GroundEstimate next =
          predicted(tracker.tracks()[0].estimate, moving(1, TargetAssumptions{}.acceleration_m_s2));
      const double deviation_m = std::sqrt(next.covariance(0, 0) + kCovariance(0, 0));
      const double away_m = std::sqrt(quantile) * deviation_m * (inside ? 0.999 : 1.001);
      tracker.look(10, {at(away_m, 0)}, everywhere);
      CHECK(tracker.tracks()[0].detections == (inside ? 11 : 10));
    }
  }
}

TEST_CASE("four targets among false detections give four tracks of their own, by each filter") {
  const auto fly = [](auto tracker) {
    Random random(32);
    std::vector<SimulatedTarget> targets;
    for (int i = 0; i < 4; ++i) targets.emplace_back(random, TargetAssumptions{});
    int followed = 0;
    int false_tracks = 0;
    int looks = 0;
    for (int step = 0; step < 100; ++step) {
      std::vector<GroundDetection> detections;
      for (SimulatedTarget& target : targets) {
        target.move(1);
        if (random.happens(0.9)) detections.push_back(target.detection(kCovariance));
      }
      for (int i = 0; i < 4; ++i) {
        detections.push_back(
            at(10'000 * (random.uniform() - 0.5), 10'000 * (random.uniform() - 0.5)));
      }
      tracker.look(step, detections, everywhere);
      if (step < 10) continue;
      ++looks;
      const auto tracks = tracker.tracks();
      for (const SimulatedTarget& target : targets) {
        followed += std::any_of(tracks.begin(), tracks.end(), [&](const Track& track) {
          return (track.estimate.place_m() - target.state().head<2>()).norm() < 30;
        });
      }
      for (const Track& track : tracks) {
        false_tracks += std::none_of(targets.begin(), targets.end(), [&](const auto& target) {
          return (track.estimate.place_m() - target.state().template head<2>()).norm() < 100;
        });
      }
    }
    CHECK(followed > 0.95 * 4 * looks);
    CHECK(false_tracks < 0.05 * 4 * looks);
  };
  fly(Tracker<KalmanTrackFilter>());
  fly(Tracker<StopMoveTrackFilter>());
}

TEST_CASE("the same detections in another order give the same tracks") {
  Random random(33);
  std::vector<SimulatedTarget> targets;
  for (int i = 0; i < 3; ++i) targets.emplace_back(random, TargetAssumptions{});
  KalmanTracker one;
  KalmanTracker two;
  for (int step = 0; step < 30; ++step) {
    std::vector<GroundDetection> detections;
    for (SimulatedTarget& target : targets) {
      target.move(1);
      detections.push_back(target.detection(kCovariance));
    }
    one.look(step, detections, everywhere);
    std::reverse(detections.begin(), detections.end());
    two.look(step, detections, everywhere);
  }
  REQUIRE(one.tracks().size() == 3);
  for (const Track& track : one.tracks()) {
    const auto others = two.tracks();
    CHECK(std::any_of(others.begin(), others.end(), [&](const Track& other) {
      return other.estimate.mean == track.estimate.mean;
    }));
  }
}

}  // namespace tracking_tracker_test
