#include "sensing/tracking/followed_target.hpp"

#include <algorithm>
#include <limits>
#include <utility>

namespace reconnaissance {
namespace {

double distance_m(const Eigen::Vector2d& place, const Eigen::Vector2d& from,
                  const Eigen::Vector2d& to) {
  const Eigen::Vector2d way = to - from;
  const double squared = way.squaredNorm();
  const double share = squared > 0 ? std::clamp((place - from).dot(way) / squared, 0.0, 1.0) : 0;
  return (place - from - share * way).norm();
}

}  // namespace

FollowedTarget::FollowedTarget(std::vector<Eigen::Vector2d> line_m, double margin_m,
                               const FollowRules& rules)
    : rules_(rules), margin_m_(margin_m) {
  expect_along(std::move(line_m));
}

void FollowedTarget::expect_along(std::vector<Eigen::Vector2d> line_m) {
  if (ever_found_) return;
  line_m_ = std::move(line_m);
  estimate_.mean.head<2>() = line_m_.front();
}

/// From where the target is expected: a place once it was found, before that anywhere along a line.
double FollowedTarget::distance_m(const Eigen::Vector2d& place_m,
                                  const Eigen::Vector2d& expected_m) const {
  double nearest_m = (place_m - (ever_found_ ? expected_m : line_m_.front())).norm();
  for (std::size_t i = 1; !ever_found_ && i < line_m_.size(); ++i)
    nearest_m =
        std::min(nearest_m, reconnaissance::distance_m(place_m, line_m_[i - 1], line_m_[i]));
  return nearest_m;
}

void FollowedTarget::look(double now_s, const std::vector<Track>& tracks) {
  const double passed_s = now_s - now_s_;
  now_s_ = now_s;
  Eigen::Vector2d expected_m = estimate_.place_m();
  if (found_) expected_m += passed_s * estimate_.mean.tail<2>();
  double nearest_m = found_ ? rules_.gate_m + rules_.wanders_m_s * (now_s - seen_s_) : margin_m_;
  const Track* target = nullptr;
  for (const Track& each : tracks) {
    const double off_m = distance_m(each.estimate.place_m(), expected_m);
    if (now_s - each.seen_s > rules_.fresh_s || off_m > nearest_m) continue;
    nearest_m = off_m;
    target = &each;
  }
  if (target) {
    if (found_) followed_s_ += passed_s;
    found_ = ever_found_ = true;
    seen_s_ = now_s;
    estimate_ = target->estimate;
    return;
  }
  if (!found_) return;
  estimate_.mean.head<2>() = expected_m;
  found_ = now_s - seen_s_ <= rules_.patience_s;
}

}  // namespace reconnaissance
