#include "sensing/tracking/track_fusion.hpp"

#include <algorithm>
#include <skein/fusion.hpp>

namespace reconnaissance {
namespace {

skein::fusion::Estimate estimate_of(const Track& track) {
  skein::fusion::Estimate estimate;
  estimate.mean.assign(track.estimate.mean.begin(), track.estimate.mean.end());
  for (int row = 0; row < 4; ++row) {
    for (int column = 0; column < 4; ++column) {
      // Rounding has made halves that differ in the last bits.
      estimate.covariance.push_back(
          (track.estimate.covariance(row, column) + track.estimate.covariance(column, row)) / 2);
    }
  }
  return estimate;
}

GroundEstimate estimate_of(const skein::fusion::Estimate& fused) {
  GroundEstimate estimate;
  estimate.mean = Eigen::Map<const GroundState>(fused.mean.data());
  estimate.covariance = Eigen::Map<const Eigen::Matrix4d>(fused.covariance.data());
  return estimate;
}

}  // namespace

std::vector<Track> fuse_tracks(const std::vector<Track>& first, const std::vector<Track>& second,
                               double gate_probability) {
  struct Pair {
    double squared_distance;
    std::size_t first, second;
  };
  const double gate = skein::fusion::chi_square_quantile(gate_probability, 4);
  std::vector<Pair> pairs;
  for (std::size_t i = 0; i < first.size(); ++i) {
    for (std::size_t j = 0; j < second.size(); ++j) {
      const double distance =
          skein::fusion::squared_distance(estimate_of(first[i]), estimate_of(second[j]));
      if (distance <= gate) pairs.push_back({distance, i, j});
    }
  }
  std::stable_sort(pairs.begin(), pairs.end(), [](const Pair& a, const Pair& b) {
    return a.squared_distance < b.squared_distance;
  });

  std::vector<Track> fused = first;
  std::vector<bool> paired(first.size());
  std::vector<bool> used(second.size());
  for (const Pair& pair : pairs) {
    if (paired[pair.first] || used[pair.second]) continue;
    paired[pair.first] = used[pair.second] = true;
    Track& track = fused[pair.first];
    const Track& other = second[pair.second];
    const std::vector both{estimate_of(track), estimate_of(other)};
    track.estimate = estimate_of(skein::fusion::intersect(both).fused);
    track.detections = std::max(track.detections, other.detections);
    track.seen_s = std::max(track.seen_s, other.seen_s);
  }
  for (std::size_t j = 0; j < second.size(); ++j) {
    if (used[j]) continue;
    fused.push_back(second[j]);
    fused.back().number += kSecondTracker;
  }
  return fused;
}

}  // namespace reconnaissance
