#include "threats/air_defence_picture.hpp"

#include <cmath>
#include <limits>
#include <set>

namespace reconnaissance {
namespace {

constexpr double kBearingGate = 0.9999;
constexpr double kLinkGate = 0.99;
constexpr double kForgetting_s = 10;
constexpr double kGreatestRelativeSigma = 0.3;
// Of the track of an emitter whose power is unknown.
constexpr Interval kAnywhere_m{1000, 60000};

Interval possible_distances_m(const Intercept& intercept, const std::string& emitter,
                              const WarnerReceiver& receiver) {
  for (const EmitterType& type : emitter_types()) {
    if (type.name != emitter) continue;
    return distance_by_power_m(intercept.power_w, type.radiated_power_w,
                               intercept.waveform.radio_frequency_hz, receiver.power_sigma_db);
  }
  return kAnywhere_m;
}

}  // namespace

void AirDefencePicture::hear(const Intercept& intercept, const Identification& identification,
                             const Local& aircraft) {
  std::erase_if(tracks_, [&](const Track& track) {
    return !track.confirmed && track.last_heard_s < intercept.time_s - kForgetting_s;
  });
  if (identification.emitter.empty()) return;
  const Bearing bearing{aircraft, intercept.bearing_rad, intercept.bearing_sigma_rad};
  std::vector<Track*> fitting;
  Track* best = nullptr;
  double least = std::numeric_limits<double>::infinity();
  for (Track& track : tracks_) {
    const BearingFilter::Innovation innovation = track.filter.innovation(bearing);
    if (innovation.squared() > skein::fusion::chi_square_quantile(kBearingGate, 1)) continue;
    fitting.push_back(&track);
    if (track.identification.emitter != identification.emitter) continue;
    // Twice the negative logarithm of the bearing's density, but for a constant.
    const double improbability = innovation.squared() + std::log(innovation.variance_rad2);
    if (best && best->confirmed != track.confirmed ? best->confirmed : improbability >= least) {
      continue;
    }
    least = improbability;
    best = &track;
  }
  for (Track* track : fitting) {
    if (track->confirmation.look(track == best)) track->confirmed = true;
  }
  if (best) {
    best->filter.update(bearing);
    best->identification = identification;
    best->last_heard_s = intercept.time_s;
    return;
  }
  const auto [nearest_m, furthest_m] =
      possible_distances_m(intercept, identification.emitter, receiver_);
  tracks_.push_back({next_id_++, identification, BearingFilter(bearing, nearest_m, furthest_m),
                     intercept.time_s});
  tracks_.back().confirmation.look(true);
}

std::vector<Threat> AirDefencePicture::threats() const {
  const double gate = skein::fusion::chi_square_quantile(kLinkGate, 2);
  std::vector<Threat> threats;
  std::set<std::uint32_t> fused;
  for (const Track& track : tracks_) {
    if (!track.confirmed || track.filter.relative_range_sigma() > kGreatestRelativeSigma) {
      continue;
    }
    Threat threat{track.id,
                  track.identification.emitter,
                  track.identification.mode,
                  track.identification.confidence,
                  track.filter.position(),
                  true,
                  false,
                  track.last_heard_s};
    const LinkTrack* nearest = nullptr;
    double least = gate;
    for (const auto& [id, link] : links_) {
      if (link.emitter != threat.emitter || fused.contains(id)) continue;
      const double difference = skein::fusion::squared_distance(threat.position, link.position);
      if (difference > least) continue;
      least = difference;
      nearest = &link;
    }
    if (nearest) {
      fused.insert(nearest->id);
      const skein::fusion::Estimate both[]{threat.position, nearest->position};
      threat.position = skein::fusion::intersect(both).fused;
      threat.linked = true;
    }
    threats.push_back(std::move(threat));
  }
  for (const auto& [id, link] : links_) {
    if (fused.contains(id)) continue;
    threats.push_back(
        {kFirstLinkNumber + id, link.emitter, RadarMode::Off, 1, link.position, false, true, 0});
  }
  return threats;
}

}  // namespace reconnaissance
