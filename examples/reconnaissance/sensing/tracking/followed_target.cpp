#include "sensing/tracking/followed_target.hpp"

namespace reconnaissance {

void FollowedTarget::look(double now_s, const std::vector<Track>& tracks) {
  const double passed_s = now_s - now_s_;
  now_s_ = now_s;
  Eigen::Vector2d expected_m = estimate_.place_m();
  if (found_) expected_m += passed_s * estimate_.mean.tail<2>();
  double nearest_m = found_ ? rules_.gate_m + rules_.wanders_m_s * (now_s - seen_s_) : margin_m_;
  const Track* target = nullptr;
  for (const Track& each : tracks) {
    const double distance_m = (each.estimate.place_m() - expected_m).norm();
    if (now_s - each.seen_s > rules_.fresh_s || distance_m > nearest_m) continue;
    nearest_m = distance_m;
    target = &each;
  }
  if (target) {
    if (found_) followed_s_ += passed_s;
    found_ = true;
    seen_s_ = now_s;
    estimate_ = target->estimate;
    return;
  }
  if (!found_) return;
  estimate_.mean.head<2>() = expected_m;
  found_ = now_s - seen_s_ <= rules_.patience_s;
}

}  // namespace reconnaissance
