#include "target_csps.hpp"

#include "target_conversion.hpp"

namespace reconnaissance {
namespace {

// What a look at an element that is reached on a planned pass is like.
constexpr double kExpectedDeviation_m = 5;
constexpr double kHalfView_m = 100;

/// Whether a place is on the same side of all edges of a convex outline.
bool is_inside(const std::vector<recon::LocalPlace>& outline, const Eigen::Vector2d& place_m) {
  bool left = false, right = false;
  for (std::size_t i = 0; i < outline.size(); ++i) {
    const recon::LocalPlace& a = outline[i];
    const recon::LocalPlace& b = outline[(i + 1) % outline.size()];
    const double side = (b.east_m - a.east_m) * (place_m[0] - a.north_m) -
                        (b.north_m - a.north_m) * (place_m[1] - a.east_m);
    left |= side > 0;
    right |= side < 0;
  }
  return !outline.empty() && !(left && right);
}

}  // namespace

recon::CollectionPlan CollectionPattern::plan(const recon::CollectionTask& task) {
  if (task.line.empty()) throw recon::NoPlan("there is no place to look at");
  if (task.watched) throw recon::NoPlan("it passes its objective, and does not stay with it");
  Objective objective{{}, task.margin_m};
  for (const recon::LocalPlace& each : task.line) objective.line.push_back(local(each));
  const auto plan =
      plan_(objective, {task.height_m, task.offset_m, task.ground_speed_m_s, task.course_rad},
            kCamera, kCameraMount);
  if (!plan) throw recon::NoPlan("the frame shows the horizon, or the flight is too fast for it");
  return collection_plan(*plan);
}

recon::CollectionPlan Watch::plan(const recon::CollectionTask& task) {
  if (!task.watched || task.line.empty())
    throw recon::NoPlan("it stays with what has been found already");
  const auto plan =
      plan_watch(local(task.line.front()), task.north_m_s, task.east_m_s,
                 {task.height_m, task.offset_m, task.ground_speed_m_s, task.course_rad}, kCamera);
  if (!plan) throw recon::NoPlan("the frame shows the horizon");
  return collection_plan(*plan);
}

std::int32_t ElementPolicy::next(const recon::ElementChoice& choice) {
  std::vector<Element> elements;
  std::vector<std::optional<Look>> looks;
  for (const recon::ElementOutlook& each : choice.elements) {
    Element element;
    element.priority = each.priority;
    element.size_m = each.size_m;
    element.wanted_gsd_m = each.wanted_ground_sample_m;
    element.deviation_m = each.deviation_m;
    if (each.achieved_ground_sample_m > 0) element.best_gsd_m = each.achieved_ground_sample_m;
    elements.push_back(element);
    looks.emplace_back();
    if (each.reachable)
      looks.back() =
          Look{each.seconds, each.wanted_ground_sample_m, kExpectedDeviation_m, kHalfView_m};
  }
  const auto next = choose_(elements, looks);
  return next ? static_cast<std::int32_t>(*next) : -1;
}

template <class Filter>
recon::TrackList TargetTracker<Filter>::look(const recon::GroundLook& look) {
  std::vector<GroundDetection> found;
  for (const recon::PlaceEstimate& each : look.found) found.push_back(ground_detection(each));
  tracker_.look(look.now_s, found,
                [&](const Eigen::Vector2d& place_m) { return is_inside(look.corners, place_m); });
  return {object_tracks(tracker_.tracks())};
}

template class TargetTracker<KalmanTrackFilter>;
template class TargetTracker<StopMoveTrackFilter>;

}  // namespace reconnaissance
