#pragma once

#include <algorithm>
#include <vector>

#include "sensing/collection.hpp"
#include "sensing/tracking/tracker.hpp"
#include "targets.idl.hpp"

namespace reconnaissance {

/// So near an emitter is to where it is placed, with a probability of 0.95 along any line.
inline double placed_within_m(const recon::Element& element) { return 2 * element.deviation_m; }

inline recon::LocalPlace local_place(const Local& place) {
  return {place.north_m, place.east_m, place.height_m};
}

inline Local local(const recon::LocalPlace& place) {
  return {place.north_m, place.east_m, place.height_m};
}

inline GroundDetection ground_detection(const recon::PlaceEstimate& found) {
  GroundDetection detection;
  detection.place_m << found.north_m, found.east_m;
  detection.covariance_m2 << found.north_north_m2, found.north_east_m2, found.north_east_m2,
      found.east_east_m2;
  return detection;
}

inline recon::CollectionPlan collection_plan(const CollectionPlan& plan) {
  recon::CollectionPlan told{{}, plan.seconds, plan.early_s, plan.coverage, plan.sample_distance_m};
  for (const Pointing& each : plan.pointings)
    told.pointings.push_back(
        {each.begin_s, each.seconds, local_place(each.from), local_place(each.to)});
  return told;
}

inline recon::ObjectTrack object_track(const Track& track) {
  recon::ObjectTrack told;
  told.number = track.number;
  std::copy_n(track.estimate.mean.data(), told.mean.size(), told.mean.begin());
  // Symmetric, so that rows are columns.
  std::copy_n(track.estimate.covariance.data(), told.covariance.size(), told.covariance.begin());
  told.detections = static_cast<std::uint32_t>(track.detections);
  told.seen_s = track.seen_s;
  return told;
}

inline Track track(const recon::ObjectTrack& told) {
  Track track;
  track.number = told.number;
  std::copy_n(told.mean.begin(), told.mean.size(), track.estimate.mean.data());
  std::copy_n(told.covariance.begin(), told.covariance.size(), track.estimate.covariance.data());
  track.detections = static_cast<int>(told.detections);
  track.seen_s = told.seen_s;
  return track;
}

inline std::vector<Track> tracks(const std::vector<recon::ObjectTrack>& told) {
  std::vector<Track> result;
  for (const recon::ObjectTrack& each : told) result.push_back(track(each));
  return result;
}

inline std::vector<recon::ObjectTrack> object_tracks(const std::vector<Track>& tracks) {
  std::vector<recon::ObjectTrack> result;
  for (const Track& each : tracks) result.push_back(object_track(each));
  return result;
}

}  // namespace reconnaissance
