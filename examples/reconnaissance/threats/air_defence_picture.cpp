#include "threats/air_defence_picture.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <set>
#include <utility>

namespace reconnaissance {
namespace {

constexpr double kBearingGate = 0.9999;
constexpr double kLinkGate = 0.99;
constexpr double kForgetting_s = 10;
// From nearer places bearings are alike.
constexpr double kLeastApart_m = 100;
// A place that moves less is the same to others.
constexpr double kLeastMove_m = 100;
// Of the track of an emitter whose power is unknown.
constexpr Interval kAnywhere_m{1000, 60000};
// So many intercepts give a distance, from places that differ by less than this share of it.
constexpr int kPowers = 4;
constexpr double kLeastParallax = 0.1;

std::optional<Interval> distances_by_power_m(const Intercept& intercept, const std::string& emitter,
                                             const WarnerReceiver& receiver) {
  for (const EmitterType& type : emitter_types()) {
    if (type.name != emitter) continue;
    return distance_by_power_m(intercept.power_w, type.radiated_power_w,
                               intercept.waveform.radio_frequency_hz, receiver.power_sigma_db);
  }
  return std::nullopt;
}

/// The mean of so many, of which the last is `one`, and of independent errors.
Interval mean_distances_m(const Interval& others, const Interval& one, int count) {
  const auto middle = [](const Interval& of) { return std::log(of.least * of.greatest) / 2; };
  const double centre = std::lerp(middle(others), middle(one), 1.0 / count);
  const double half = std::log(one.greatest / one.least) / 2 / std::sqrt(count);
  return {std::exp(centre - half), std::exp(centre + half)};
}

Bearing joined_bearing(const Bearing& a, const Bearing& b) {
  const double a_weight = 1 / (a.sigma_rad * a.sigma_rad);
  const double b_weight = 1 / (b.sigma_rad * b.sigma_rad);
  const double share = b_weight / (a_weight + b_weight);
  const double difference = std::remainder(b.bearing_rad - a.bearing_rad, 2 * std::numbers::pi);
  return {{std::lerp(a.from.north_m, b.from.north_m, share),
           std::lerp(a.from.east_m, b.from.east_m, share),
           std::lerp(a.from.height_m, b.from.height_m, share)},
          a.bearing_rad + share * difference,
          1 / std::sqrt(a_weight + b_weight)};
}

/// The first stays: what is known of its distance holds for its place. Those that are far apart
/// stay as long as others do: the mean of their bearings is not that from their middle.
void join_neighbours(std::vector<Bearing>& bearings) {
  for (double apart_m = kLeastApart_m; bearings.size() >= kGreatestBearings; apart_m *= 2) {
    std::vector<Bearing> kept{bearings.front()};
    for (std::size_t i = 1; i < bearings.size(); ++i) {
      const bool pair = i + 1 < bearings.size() &&
                        map_distance_m(bearings[i].from, bearings[i + 1].from) < apart_m;
      kept.push_back(pair ? joined_bearing(bearings[i], bearings[i + 1]) : bearings[i]);
      if (pair) ++i;
    }
    bearings = std::move(kept);
  }
}

}  // namespace

std::optional<skein::fusion::Estimate> by_filter(std::span<const Bearing> bearings,
                                                 const Interval& distances_m) {
  return filter_bearings(bearings, distances_m.least, distances_m.greatest);
}

std::optional<skein::fusion::Estimate> by_triangulation(std::span<const Bearing> bearings,
                                                        const Interval&) {
  return triangulate(bearings);
}

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
    if (best->powers < kPowers) measure(*best, intercept, aircraft);
    best->filter.update(bearing);
    if (best->bearings.size() == kGreatestBearings) join_neighbours(best->bearings);
    best->bearings.push_back(bearing);
    best->identification = identification;
    best->last_heard_s = intercept.time_s;
    return;
  }
  const auto by_power_m = distances_by_power_m(intercept, identification.emitter, receiver_);
  const Interval distances_m = by_power_m.value_or(kAnywhere_m);
  tracks_.push_back({next_id_++,
                     identification,
                     distances_m,
                     BearingFilter(bearing, distances_m.least, distances_m.greatest),
                     {bearing},
                     intercept.time_s,
                     by_power_m ? 1 : kPowers});
  tracks_.back().confirmation.look(true);
}

void AirDefencePicture::measure(Track& track, const Intercept& intercept, const Local& aircraft) {
  const auto one_m = distances_by_power_m(intercept, track.identification.emitter, receiver_);
  const Bearing& first = track.bearings.front();
  if (!one_m || map_distance_m(first.from, aircraft) > kLeastParallax * track.distances_m.least) {
    track.powers = kPowers;
    return;
  }
  track.distances_m = mean_distances_m(track.distances_m, *one_m, ++track.powers);
  track.filter = BearingFilter(first, track.distances_m.least, track.distances_m.greatest);
  for (const Bearing& each : std::span(track.bearings).subspan(1)) track.filter.update(each);
}

std::vector<Threat> AirDefencePicture::threats(const Locate& locate) const {
  const double gate = skein::fusion::chi_square_quantile(kLinkGate, 2);
  std::vector<Threat> threats;
  std::set<std::uint32_t> fused;
  for (const Track& track : tracks_) {
    if (!track.confirmed) continue;
    const auto position = locate(track.bearings, track.distances_m);
    if (!position) continue;
    Threat threat{track.id,
                  track.identification.emitter,
                  track.identification.mode,
                  track.identification.confidence,
                  *position,
                  true,
                  false,
                  *position};
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
        {kFirstLinkNumber + id, link.emitter, RadarMode::Off, 1, link.position, false, true, {}});
  }
  return threats;
}

bool differ(const std::vector<Threat>& one, const std::vector<Threat>& other) {
  return !std::ranges::equal(one, other, [](const Threat& a, const Threat& b) {
    const double moved_m = std::hypot(a.position.mean[0] - b.position.mean[0],
                                      a.position.mean[1] - b.position.mean[1]);
    return a.id == b.id && a.emitter == b.emitter &&
           moved_m <= std::max(kLeastMove_m, greatest_deviation_m(a.position));
  });
}

double greatest_deviation_m(const skein::fusion::Estimate& place) {
  const double mean = (place.covariance[0] + place.covariance[3]) / 2;
  const double half = (place.covariance[0] - place.covariance[3]) / 2;
  return std::sqrt(mean + std::hypot(half, place.covariance[1]));
}

}  // namespace reconnaissance
