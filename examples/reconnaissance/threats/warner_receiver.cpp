#include "threats/warner_receiver.hpp"

#include <cmath>
#include <numbers>

namespace reconnaissance {
namespace {

constexpr double kLight_m_s = 299792458;

}  // namespace

double received_power_w(double radiated_power_w, double radio_frequency_hz, double range_m) {
  const double wavelength_m = kLight_m_s / radio_frequency_hz;
  return radiated_power_w * std::pow(wavelength_m / (4 * std::numbers::pi * range_m), 2);
}

Interval distance_by_power_m(double received_power_w, double radiated_power_w,
                             double radio_frequency_hz, double power_sigma_db) {
  const double distance_m = std::sqrt(
      reconnaissance::received_power_w(radiated_power_w, radio_frequency_hz, 1) / received_power_w);
  // A uniform distribution is as wide as sqrt(12) standard deviations; 20 dB are a factor of 10.
  const double factor = std::pow(10, std::sqrt(3) * power_sigma_db / 20);
  return {distance_m / factor, distance_m * factor};
}

std::optional<Intercept> receive(const Emission& emission, const Local& aircraft,
                                 const WarnerReceiver& receiver, const GroundHeight& ground,
                                 Random& random) {
  const double power_w =
      received_power_w(emission.radiated_power_w, emission.waveform.radio_frequency_hz,
                       slant_range_m(aircraft, emission.antenna));
  if (power_w < receiver.sensitivity_w) return std::nullopt;
  if (!in_sight(aircraft, emission.antenna, ground, kRadioEarth)) return std::nullopt;
  const double bearing = course_between_rad(aircraft, emission.antenna);
  const auto noisy = [&](double value, double sigma) { return value + sigma * random.normal(); };
  const Waveform& sent = emission.waveform;
  const double measured_bearing = std::remainder(
      noisy(bearing + receiver.bearing_bias_rad, receiver.bearing_sigma_rad), 2 * std::numbers::pi);
  const Waveform measured{
      .radio_frequency_hz = noisy(sent.radio_frequency_hz, receiver.radio_frequency_sigma_hz),
      .pulse_interval_s =
          noisy(sent.pulse_interval_s, receiver.pulse_interval_sigma_share * sent.pulse_interval_s),
      .scan_s = noisy(sent.scan_s, receiver.scan_sigma_s),
  };
  return Intercept{emission.time_s, measured_bearing, receiver.bearing_sigma_rad, measured,
                   power_w * std::pow(10, receiver.power_sigma_db * random.normal() / 10)};
}

}  // namespace reconnaissance
