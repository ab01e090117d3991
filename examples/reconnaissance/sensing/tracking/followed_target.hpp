#pragma once

#include <vector>

#include "sensing/tracking/tracker.hpp"

namespace reconnaissance {

struct FollowRules {
  double fresh_s = 2;       ///< A track whose target was not detected for longer is a memory.
  double gate_m = 150;      ///< A track belongs to the target so near to where that should be,
  double wanders_m_s = 10;  ///< and so much further for each second since it was seen.
  double patience_s = 15;   ///< Unseen for longer the target is lost.
};

/// Of the tracks of all that moves about, that of one target: it was reported somewhere along a
/// line, is found when there is a track near that line, and lost when there has been none for a
/// while. Then it is looked for where it was last. A pure object.
class FollowedTarget {
 public:
  /// `margin_m`: a track so near to the line, or to where the target was lost, is the target's.
  FollowedTarget(std::vector<Eigen::Vector2d> line_m, double margin_m,
                 const FollowRules& rules = {});

  /// It may be anywhere along another line, unless it was found.
  void expect_along(std::vector<Eigen::Vector2d> line_m);

  /// All tracks at a time no earlier than that of the last look.
  void look(double now_s, const std::vector<Track>& tracks);

  bool found() const { return found_; }
  bool was_ever_found() const { return ever_found_; }
  /// Where it is, or was lost, at the last look; before, an end of its line.
  const GroundEstimate& estimate() const { return estimate_; }
  /// For how long there was a fresh track of it.
  double followed_s() const { return followed_s_; }

 private:
  double distance_m(const Eigen::Vector2d& place_m, const Eigen::Vector2d& expected_m) const;

  FollowRules rules_;
  std::vector<Eigen::Vector2d> line_m_;  // along which it is looked for
  double margin_m_;
  GroundEstimate estimate_;
  bool found_ = false;
  bool ever_found_ = false;
  double now_s_ = 0;
  double seen_s_ = 0;
  double followed_s_ = 0;
};

}  // namespace reconnaissance
