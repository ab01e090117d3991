#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "convert.hpp"
#include "planning/threat_discs.hpp"
#include "threats.idl.hpp"
#include "threats/air_defence_picture.hpp"

namespace reconnaissance {

inline recon::RadarMode radar_mode(RadarMode mode) {
  return static_cast<recon::RadarMode>(static_cast<int>(mode));
}
inline RadarMode radar_mode(recon::RadarMode mode) {
  return static_cast<RadarMode>(static_cast<int>(mode));
}
static_assert(static_cast<int>(RadarMode::Guidance) ==
              static_cast<int>(recon::RadarMode::Guidance));

inline recon::Intercept intercept(const Intercept& heard, std::uint32_t train) {
  return {train,
          heard.bearing_rad,
          heard.bearing_sigma_rad,
          heard.waveform.radio_frequency_hz,
          heard.waveform.pulse_interval_s,
          heard.waveform.scan_s,
          heard.power_w};
}

inline Intercept intercept(const recon::Intercept& heard, double time_s) {
  return {time_s,
          heard.bearing_rad,
          heard.bearing_deviation_rad,
          {heard.frequency_hz, heard.pulse_interval_s, heard.scan_s},
          heard.power_w};
}

inline recon::Identification identification(const Identification& found) {
  return {found.emitter, radar_mode(found.mode), found.confidence};
}

inline Identification identification(const recon::Identification& found) {
  return {found.emitter, radar_mode(found.mode), found.confidence};
}

inline recon::BearingTrack bearing_track(std::span<const Bearing> bearings,
                                         const Interval& distances_m) {
  recon::BearingTrack track{{}, distances_m.least, distances_m.greatest};
  track.bearings.reserve(bearings.size());
  for (const Bearing& each : bearings)
    track.bearings.push_back(
        {each.from.north_m, each.from.east_m, each.bearing_rad, each.sigma_rad});
  return track;
}

inline std::vector<Bearing> bearings_of(const recon::BearingTrack& track) {
  std::vector<Bearing> bearings;
  bearings.reserve(track.bearings.size());
  for (const recon::BearingLine& each : track.bearings)
    bearings.push_back({{each.north_m, each.east_m, 0}, each.bearing_rad, each.deviation_rad});
  return bearings;
}

inline recon::PlaceEstimate place_estimate(const skein::fusion::Estimate& place) {
  return {place.mean[0], place.mean[1], place.covariance[0], place.covariance[1],
          place.covariance[3]};
}

/// The map's directions at the frame's origin are taken for those of the place: 50 km away they
/// differ by half a degree, which no error of a place shows.
inline recon::LinkedSite linked_site(const LocalFrame& frame, std::uint32_t number,
                                     const std::string& kind, const skein::fusion::Estimate& place,
                                     std::vector<std::string> reporters) {
  return {number,
          kind,
          position(frame, Local{place.mean[0], place.mean[1], 0}),
          place.covariance[0],
          place.covariance[1],
          place.covariance[3],
          std::move(reporters)};
}

inline LinkTrack link_track(const LocalFrame& frame, const recon::LinkedSite& site) {
  const Local place = local(frame, site.position);
  return {site.number,
          site.kind,
          {{place.north_m, place.east_m},
           {site.north_north_m2, site.north_east_m2, site.north_east_m2, site.east_east_m2}}};
}

inline skein::fusion::Estimate estimate(const recon::PlaceEstimate& place) {
  return {{place.north_m, place.east_m},
          {place.north_north_m2, place.north_east_m2, place.north_east_m2, place.east_east_m2}};
}

/// What the weapons of a picture may reach, or by another `reach`.
inline std::vector<ThreatDisc> discs_of(const recon::ThreatPicture& picture,
                                        const LocalFrame& frame,
                                        double (*reach)(double, double) = reach_m) {
  std::vector<ThreatDisc> discs;
  for (const recon::Threat& threat : picture.threats) {
    if (threat.lethal_range_m == 0) continue;
    const Local site = local(frame, threat.position);
    discs.push_back({site.north_m, site.east_m, reach(threat.lethal_range_m, threat.deviation_m),
                     kKills_per_s});
  }
  return discs;
}

inline std::vector<ThreatDisc> discs_of(const std::vector<recon::WeaponReach>& weapons) {
  std::vector<ThreatDisc> discs;
  for (const recon::WeaponReach& each : weapons)
    discs.push_back({each.north_m, each.east_m, each.radius_m, each.kills_per_s});
  return discs;
}

inline std::vector<recon::WeaponReach> weapons_of(const std::vector<ThreatDisc>& discs) {
  std::vector<recon::WeaponReach> weapons;
  for (const ThreatDisc& each : discs)
    weapons.push_back({each.north_m, each.east_m, each.radius_m, each.kills_per_s});
  return weapons;
}

}  // namespace reconnaissance
