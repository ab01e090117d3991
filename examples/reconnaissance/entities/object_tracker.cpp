#include "object_tracker.hpp"

#include "convert.hpp"
#include "deciding.hpp"
#include "sensing/tracking/track_fusion.hpp"
#include "target_conversion.hpp"
#include "topics.hpp"

namespace reconnaissance {
namespace {

/// Why tracks are none; nothing if they are.
std::optional<std::string> are_no_tracks(const recon::TrackList& list) {
  for (const recon::ObjectTrack& each : list.tracks) {
    const Track known = track(each);
    if (!known.estimate.mean.allFinite() || !known.estimate.covariance.ldlt().isPositive())
      return "track " + std::to_string(each.number) + " has no covariance of an error";
  }
  return std::nullopt;
}

/// By covariance intersection, since all have seen the same images.
std::optional<skein::Synthesised<recon::TrackList>> fuse(
    const std::vector<skein::Opinion<recon::TrackList>>& opinions) {
  std::vector<Track> fused = tracks(opinions.front().result.tracks);
  std::string names = opinions.front().csp;
  for (std::size_t i = 1; i < opinions.size(); ++i) {
    fused = fuse_tracks(fused, tracks(opinions[i].result.tracks));
    names += ", " + opinions[i].csp;
  }
  return skein::Synthesised<recon::TrackList>{{object_tracks(fused)}, names + " fused"};
}

}  // namespace

ObjectTracker::ObjectTracker(skein::Entity& entity, const skein::ParameterValues& values)
    : entity_(entity),
      images_(entity, topic::kImages, {}),
      tracks_(entity.publisher<recon::ObjectTracks>(topic::kTracks.name, skein::TopicQos::state())),
      member_(entity, values, [this](Tick tick) { follow(tick); }) {}

void ObjectTracker::follow(Tick tick) {
  for (const recon::Images& batch : images_.take(tick)) {
    told_.origin = batch.origin;
    const LocalFrame frame(geodetic(batch.origin));
    for (const recon::Image& image : batch.images) {
      recon::GroundLook look{seconds_of(batch.tick), image.found, {}};
      for (const recon::Position& corner : image.corners)
        look.corners.push_back(local_place(local(frame, corner)));
      told_.tracks = ask_trackers(look).tracks;
    }
  }
  told_.tick = tick;
  tracks_.publish(told_);
}

recon::TrackList ObjectTracker::ask_trackers(const recon::GroundLook& look) {
  skein::Task<recon::ITargetTracker, recon::TrackList> task;
  task.request = "a look at the ground";
  task.features = {{"found", static_cast<double>(look.found.size())}};
  task.execution = skein::Execution::All;
  task.enough = skein::TaskOptions::kAll;
  task.run = [&](recon::ITargetTracker::Proxy& tracker, skein::Duration) {
    return tracker.async_look(look);
  };
  task.evaluate.check("are tracks", are_no_tracks);
  task.synthesis = by_names<recon::TrackList>(fuse);
  return decide(entity_, task).value_or(recon::TrackList{});
}

}  // namespace reconnaissance
