#pragma once

#include <cstdint>
#include <limits>
#include <optional>

#include "geodesy/line_of_sight.hpp"
#include "random.hpp"
#include "threats/radar_detection.hpp"

namespace reconnaissance {

/// What a radar of a missile site does: nothing yet, look for targets all around, follow one, or
/// guide a missile to it.
enum class RadarMode { Off, Search, Track, Guidance };

/// How a radar transmits in a mode.
struct Waveform {
  double radio_frequency_hz;
  double pulse_interval_s;
  double scan_s;  ///< Of one turn of the antenna; 0 if it stays on the target.
};

/// What a radar transmits at a time: what a warner can measure.
struct Emission {
  std::uint32_t emitter;
  double time_s;
  Local antenna;
  RadarMode mode;
  Waveform waveform;
  double radiated_power_w;  ///< Effective: with the antenna's gain.
};

/// Where a missile can hit: a layer of a ball about the site.
struct WeaponZone {
  double least_range_m = 0;
  double greatest_range_m;
  double least_height_m = 0;  ///< Above the site.
  double greatest_height_m;
  double kills_per_s;

  bool contains(const Local& site, const Local& aircraft) const;
};

/// A radar with its launcher. The defaults are those of a short-range system with a mechanically
/// turned search antenna.
struct RadarSite {
  std::uint32_t emitter;
  Local antenna;
  double active_from_s = 0;  ///< When a site that pops up begins to search.
  /// A site that lies in wait begins when the aircraft has come so near: others tell it.
  double silent_beyond_m = std::numeric_limits<double>::infinity();
  double constant_j_m2_k;  ///< As of radar_constant().
  double false_alarm_probability = 1e-6;
  double radiated_power_w;
  Waveform search;
  Waveform track;
  Waveform guidance;
  int confirming_looks = 2;   ///< So many detections
  int looks = 3;              ///< of so many looks confirm a track.
  int misses_until_lost = 5;  ///< In a row, of a track.
  double reaction_s = 8;      ///< From a track to the launch of a missile.
  WeaponZone zone;
};

/// What a radar looks at.
struct RadarTarget {
  Local place;
  Attitude attitude;
  Ellipsoid shape;
};

/// The modes of a radar in the presence of one aircraft.
///
/// Off, until the site is active and the target near enough; it does not fall silent again. Search:
/// one look a turn of the antenna; confirmed by m of n looks it becomes Track: two looks a second.
/// When a track has lasted for the time of reaction and the target is in the weapon's zone,
/// Guidance: ten looks a second. Back to Track when the target leaves the zone, back to Search when
/// too many looks in a row have missed.
///
/// One thread at a time may use it.
class Radar {
 public:
  Radar(const RadarSite& site, std::uint64_t seed)
      : site_(site), random_(seed), track_(site.confirming_looks, site.looks) {}

  /// To be called at times that do not decrease, as often as emissions are wanted (50 times a
  /// second, for example). Returns what is transmitted now: twice a second in Search, 5 times in
  /// Track, 10 times in Guidance, at once when the mode has changed.
  std::optional<Emission> step(double time_s, const RadarTarget& target,
                               const GroundHeight& ground);

  RadarMode mode() const { return mode_; }

  /// The probability with which the radar's last look detected; 0 if the ground hid the target.
  double last_detection_probability() const { return last_probability_; }

 private:
  void look(double time_s, const RadarTarget& target, const GroundHeight& ground);
  void enter(RadarMode mode, double time_s);

  RadarSite site_;
  Random random_;
  TrackConfirmation track_;
  RadarMode mode_ = RadarMode::Off;
  double tracked_since_s_ = 0;
  double next_look_s_ = 0;
  double next_emission_s_ = 0;
  double last_probability_ = 0;
  int misses_ = 0;
};

/// How probable one look at the target is to detect it: 0 if the ground hides it.
double look_probability(const RadarSite& site, const RadarTarget& target,
                        const GroundHeight& ground);

}  // namespace reconnaissance
