#pragma once

#include <vector>

#include "sensing/tracking/tracker.hpp"

namespace reconnaissance {

constexpr std::uint32_t kSecondTracker = 1'000'000;

/// One list from those of two trackers. Tracks of one target are paired, nearest first, if they
/// agree (squared distance (a − b)ᵀ (A + B)⁻¹ (a − b) inside the chi-square gate of 4 degrees of
/// freedom), and become one by covariance intersection (skein::fusion::intersect): trackers that
/// share detections or a motion model make errors of unknown correlation, and to take those for
/// independent would be overconfident. Tracks without a partner are kept as they are. A fused track
/// has the first list's number; one of the second list alone has its own plus kSecondTracker.
std::vector<Track> fuse_tracks(const std::vector<Track>& first, const std::vector<Track>& second,
                               double gate_probability = 0.99);

}  // namespace reconnaissance
