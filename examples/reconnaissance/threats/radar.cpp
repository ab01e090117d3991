#include "threats/radar.hpp"

namespace reconnaissance {
namespace {

// Each tick of a clock may be a little early by rounding.
constexpr double kTickTolerance_s = 1e-6;

double look_interval_s(const RadarSite& site, RadarMode mode) {
  switch (mode) {
    case RadarMode::Search:
      return site.search.scan_s;
    case RadarMode::Track:
      return 0.5;
    default:
      return 0.1;
  }
}

double emission_interval_s(RadarMode mode) {
  switch (mode) {
    case RadarMode::Search:
      return 0.5;
    case RadarMode::Track:
      return 0.2;
    default:
      return 0.1;
  }
}

const Waveform& waveform(const RadarSite& site, RadarMode mode) {
  switch (mode) {
    case RadarMode::Search:
      return site.search;
    case RadarMode::Track:
      return site.track;
    default:
      return site.guidance;
  }
}

}  // namespace

bool WeaponZone::contains(const Local& site, const Local& aircraft) const {
  const double range = slant_range_m(site, aircraft);
  const double height = aircraft.height_m - site.height_m;
  return range >= least_range_m && range <= greatest_range_m && height >= least_height_m &&
         height <= greatest_height_m;
}

double look_probability(const RadarSite& site, const RadarTarget& target,
                        const GroundHeight& ground) {
  if (!in_sight(site.antenna, target.place, ground, kRadioEarth)) return 0;
  const double cross_section =
      aspect_cross_section_m2(target.shape, target.place, target.attitude, site.antenna);
  return detection_probability(signal_to_noise(site.constant_j_m2_k, cross_section,
                                               slant_range_m(site.antenna, target.place)),
                               site.false_alarm_probability);
}

std::optional<Emission> Radar::step(double time_s, const RadarTarget& target,
                                    const GroundHeight& ground) {
  if (mode_ == RadarMode::Off) {
    if (time_s < site_.active_from_s ||
        slant_range_m(site_.antenna, target.place) > site_.silent_beyond_m)
      return std::nullopt;
    enter(RadarMode::Search, time_s);
  }
  if (time_s + kTickTolerance_s >= next_look_s_) look(time_s, target, ground);
  if (time_s + kTickTolerance_s < next_emission_s_) return std::nullopt;
  next_emission_s_ = time_s + emission_interval_s(mode_);
  return Emission{site_.emitter,         time_s, site_.antenna, mode_, waveform(site_, mode_),
                  site_.radiated_power_w};
}

void Radar::look(double time_s, const RadarTarget& target, const GroundHeight& ground) {
  last_probability_ = look_probability(site_, target, ground);
  const bool detected = random_.happens(last_probability_);
  misses_ = detected ? 0 : misses_ + 1;
  const bool in_zone = site_.zone.contains(site_.antenna, target.place);
  next_look_s_ = time_s + look_interval_s(site_, mode_);
  if (mode_ == RadarMode::Search) {
    if (!track_.look(detected)) return;
    tracked_since_s_ = time_s;
    enter(RadarMode::Track, time_s);
  } else if (misses_ >= site_.misses_until_lost) {
    enter(RadarMode::Search, time_s);
  } else if (mode_ == RadarMode::Track && in_zone &&
             time_s + kTickTolerance_s >= tracked_since_s_ + site_.reaction_s) {
    enter(RadarMode::Guidance, time_s);
  } else if (mode_ == RadarMode::Guidance && !in_zone) {
    enter(RadarMode::Track, time_s);
  }
}

void Radar::enter(RadarMode mode, double time_s) {
  mode_ = mode;
  misses_ = 0;
  if (mode == RadarMode::Search) track_.forget();
  next_look_s_ = time_s + look_interval_s(site_, mode);
  next_emission_s_ = time_s;
}

}  // namespace reconnaissance
