#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <functional>
#include <utility>
#include <vector>

#include "sensing/tracking/track_filters.hpp"

namespace reconnaissance {

struct TrackerRules {
  double gate_probability = 0.99;  ///< That a target's own detection is inside its gate.
  int confirm_hits = 3;            ///< A track is confirmed by so many detections …
  int confirm_scans = 5;           ///< … in so many looks, or else deleted.
  int delete_misses = 5;           ///< A confirmed one is deleted after so many looks in a row
                                   ///< that did not find it.
  double lost_deviation_m = 500;   ///< Or when its place is no better known than that.
};

/// A confirmed track as others see it. Numbers are not used again.
struct Track {
  std::uint32_t number = 0;
  GroundEstimate estimate;
  int detections = 0;
  double seen_s = 0;  ///< When last.
};

/// Follows ground targets from detections without identity: gates by chi-square (2 degrees of
/// freedom, whose quantile is −2 ln(1 − p)), assigns the nearest pair first, each at most once, and
/// begins and ends tracks by counting. The filter is KalmanTrackFilter or StopMoveTrackFilter.
template <class Filter>
class Tracker {
 public:
  explicit Tracker(const TargetAssumptions& assumptions = {}, const TrackerRules& rules = {})
      : assumptions_(assumptions), rules_(rules) {}

  /// One look: all that was detected at a time no earlier than that of the last. A track that was
  /// not detected has been missed only if its place was in view.
  void look(double now_s, const std::vector<GroundDetection>& detections,
            const std::function<bool(const Eigen::Vector2d& place_m)>& in_view) {
    for (Candidate& one : candidates_) {
      one.filter.predict(now_s - now_s_);
      one.was_in_view = in_view(one.filter.estimate().place_m());
      one.looks += one.was_in_view;
      ++one.misses;
    }
    now_s_ = now_s;
    const std::vector<bool> used = assign(detections);
    for (Candidate& one : candidates_) {
      if (!one.was_in_view && one.misses > 0) --one.misses;
    }
    std::erase_if(candidates_, [&](const Candidate& one) { return is_over(one); });
    for (std::size_t i = 0; i < detections.size(); ++i) {
      if (!used[i]) candidates_.push_back({0, Filter(detections[i], assumptions_), 1, 1, 0, now_s});
    }
  }

  /// Confirmed ones, in the order of their numbers, at the time of the last look.
  std::vector<Track> tracks() const {
    std::vector<Track> confirmed;
    for (const Candidate& one : candidates_) {
      if (one.number == 0) continue;
      confirmed.push_back({one.number, one.filter.estimate(), one.hits, one.seen_s});
    }
    std::sort(confirmed.begin(), confirmed.end(),
              [](const Track& a, const Track& b) { return a.number < b.number; });
    return confirmed;
  }

 private:
  struct Candidate {
    std::uint32_t number;  // 0 until confirmed
    Filter filter;
    int hits;
    int looks;
    int misses;  // in a row
    double seen_s;
    bool was_in_view = true;
  };

  std::vector<bool> assign(const std::vector<GroundDetection>& detections) {
    struct Pair {
      double squared_distance;
      std::size_t candidate, detection;
    };
    const double gate = -2 * std::log(1 - rules_.gate_probability);
    std::vector<Pair> pairs;
    for (std::size_t c = 0; c < candidates_.size(); ++c) {
      for (std::size_t d = 0; d < detections.size(); ++d) {
        const double distance = candidates_[c].filter.squared_distance(detections[d]);
        if (distance <= gate) pairs.push_back({distance, c, d});
      }
    }
    // Confirmed tracks choose first: what is left may begin others.
    std::stable_sort(pairs.begin(), pairs.end(), [&](const Pair& a, const Pair& b) {
      const bool a_waits = candidates_[a.candidate].number == 0;
      const bool b_waits = candidates_[b.candidate].number == 0;
      return std::pair(a_waits, a.squared_distance) < std::pair(b_waits, b.squared_distance);
    });
    std::vector<bool> used(detections.size());
    std::vector<bool> served(candidates_.size());
    for (const Pair& pair : pairs) {
      if (used[pair.detection] || served[pair.candidate]) continue;
      used[pair.detection] = served[pair.candidate] = true;
      hit(candidates_[pair.candidate], detections[pair.detection]);
    }
    return used;
  }

  void hit(Candidate& one, const GroundDetection& detection) {
    one.filter.update(detection);
    one.seen_s = now_s_;
    one.misses = 0;
    ++one.hits;
    if (!one.was_in_view) ++one.looks;
    if (one.number == 0 && one.hits >= rules_.confirm_hits) one.number = next_number_++;
  }

  bool is_over(const Candidate& one) const {
    const double variance = one.filter.estimate().covariance.template topLeftCorner<2, 2>().trace();
    if (variance > 2 * rules_.lost_deviation_m * rules_.lost_deviation_m) return true;
    if (one.number != 0) return one.misses >= rules_.delete_misses;
    // Can it still be confirmed?
    return rules_.confirm_hits - one.hits > rules_.confirm_scans - one.looks;
  }

  TargetAssumptions assumptions_;
  TrackerRules rules_;
  std::vector<Candidate> candidates_;
  std::uint32_t next_number_ = 1;
  double now_s_ = 0;
};

}  // namespace reconnaissance
