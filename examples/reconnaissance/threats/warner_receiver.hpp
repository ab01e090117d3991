#pragma once

#include <optional>

#include "geodesy/line_of_sight.hpp"
#include "random.hpp"
#include "threats/radar.hpp"

namespace reconnaissance {

/// A radar warner's receiver: standard deviations of what it measures, and what it hears. The
/// defaults are those of an interferometer on a small aircraft.
struct WarnerReceiver {
  double bearing_sigma_rad = 0.035;  ///< 2 degrees.
  double bearing_bias_rad = 0;       ///< Clockwise, of all bearings; nobody knows of it.
  double radio_frequency_sigma_hz = 20e6;
  double pulse_interval_sigma_share = 0.02;  ///< Of the interval.
  double scan_sigma_s = 0.2;
  double power_sigma_db = 3;    ///< With what antennas and the path do to it.
  double sensitivity_w = 1e-9;  ///< -60 dBm at an antenna without gain.
};

/// What a warner measured of an emission.
struct Intercept {
  double time_s;
  double bearing_rad;  ///< Of the emitter, clockwise from true north, from -π to π.
  double bearing_sigma_rad;
  Waveform waveform;
  double power_w;
};

/// The power that an antenna without gain receives, P λ² / (4π R)² (Friis, "A note on a simple
/// transmission formula", Proc. IRE 34, 1946). It falls with the square of the range, an echo with
/// its fourth power: a warner hears a radar before the radar sees it.
double received_power_w(double radiated_power_w, double radio_frequency_hz, double range_m);

/// Between two values.
struct Interval {
  double least;
  double greatest;
};

/// Within which distances an emitter is whose power is known and was received with a normal error
/// of so many decibels. A distance with a uniform logarithm within them has the variance that the
/// error gives it.
Interval distance_by_power_m(double received_power_w, double radiated_power_w,
                             double radio_frequency_hz, double power_sigma_db);

/// What the receiver measures of an emission at a place: nullopt if the ground hides the emitter or
/// it is too weak. All errors are normal and independent.
std::optional<Intercept> receive(const Emission& emission, const Local& aircraft,
                                 const WarnerReceiver& receiver, const GroundHeight& ground,
                                 Random& random);

}  // namespace reconnaissance
