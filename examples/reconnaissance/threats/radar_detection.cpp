#include "threats/radar_detection.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace reconnaissance {
namespace {

constexpr double kBoltzmann_j_k = 1.380649e-23;  // Exact since the SI of 2019.
constexpr double kReceiver_k = 290;              // The reference temperature of noise figures.

}  // namespace

double radar_constant(const Transmitter& transmitter) {
  return transmitter.peak_power_w * std::pow(transmitter.antenna_gain, 2) *
         std::pow(transmitter.wavelength_m, 2) /
         (std::pow(4 * std::numbers::pi, 3) * kReceiver_k * transmitter.bandwidth_hz *
          transmitter.noise_figure * transmitter.losses);
}

double signal_to_noise(double radar_constant_j_m2_k, double cross_section_m2, double range_m) {
  return radar_constant_j_m2_k * cross_section_m2 / (kBoltzmann_j_k * std::pow(range_m, 4));
}

double detection_probability(double signal_to_noise, double false_alarm_probability) {
  return 0.5 * std::erfc(std::sqrt(-std::log(false_alarm_probability)) -
                         std::sqrt(signal_to_noise + 0.5));
}

double Ellipsoid::cross_section_m2(const Eigen::Vector3d& to_radar_in_body) const {
  const Eigen::Array3d half_axes(forward_m, right_m, down_m);
  const double square = (to_radar_in_body.normalized().array() * half_axes).square().sum();
  return std::numbers::pi * half_axes.square().prod() / (square * square);
}

double aspect_cross_section_m2(const Ellipsoid& shape, const Local& aircraft,
                               const Attitude& attitude, const Local& radar) {
  return shape.cross_section_m2(body_to_ned(attitude).transpose() * ned_between(aircraft, radar));
}

bool TrackConfirmation::look(bool detected) {
  looks_.push_back(detected);
  if (static_cast<int>(looks_.size()) > n_) looks_.pop_front();
  return std::count(looks_.begin(), looks_.end(), true) >= m_;
}

}  // namespace reconnaissance
