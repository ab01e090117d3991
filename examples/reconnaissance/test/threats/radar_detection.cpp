#include "threats/radar_detection.hpp"

#include <boost/math/distributions/non_central_chi_squared.hpp>
#include <catch2/catch.hpp>
#include <cmath>
#include <numbers>

namespace radar_detection_test {

using namespace reconnaissance;

namespace {

constexpr double kPi = std::numbers::pi;

double ratio(double decibels) { return std::pow(10, decibels / 10); }

/// The exact probability, Marcum's Q of order 1: the tail of a non-central chi-square distribution
/// of 2 degrees of freedom.
double marcum(double signal_to_noise, double false_alarm_probability) {
  const boost::math::non_central_chi_squared power(2, 2 * signal_to_noise);
  return cdf(complement(power, -2 * std::log(false_alarm_probability)));
}

}  // namespace

TEST_CASE("The judge knows a published exact value") {
  // Nine of ten at one in a million need 13.183490 dB (documentation of Hostetter's Python package
  // sdr, 2024, min_snr).
  CHECK(marcum(ratio(13.183490056794499), 1e-6) == Approx(0.9).epsilon(1e-9));
}

TEST_CASE("North's probability of a detection is within 0.007 of Marcum's exact one") {
  double worst = 0;
  for (const double false_alarm : {1e-3, 1e-4, 1e-5, 1e-6, 1e-7, 1e-8, 1e-10}) {
    for (double decibels = 0; decibels <= 18; decibels += 0.25) {
      const double snr = ratio(decibels);
      worst = std::max(
          worst, std::abs(detection_probability(snr, false_alarm) - marcum(snr, false_alarm)));
    }
  }
  INFO("worst difference " << worst);
  CHECK(worst < 0.007);
}

TEST_CASE("A textbook's radar sees as far as the textbook says") {
  // Mahafza, Radar Systems Analysis and Design Using MATLAB, 2000, example 1.4: C band, 1.5 MW,
  // 45 dB, 0.2 us, 3 dB of noise; 0.1 m2 give 20 dB at 86.2 km.
  const Transmitter radar{
      .peak_power_w = 1.5e6,
      .antenna_gain = ratio(45),
      .wavelength_m = 0.054,
      .bandwidth_hz = 5e6,
      .noise_figure = ratio(3),
  };
  const double snr = signal_to_noise(radar_constant(radar), 0.1, 86199);
  CHECK(10 * std::log10(snr) == Approx(20).margin(0.1));
  CHECK(signal_to_noise(radar_constant(radar), 0.1, 86199 / 2.0) == Approx(16 * snr));
}

TEST_CASE("An ellipsoid's cross-section follows from its curvature") {
  // A sphere shows its disc from everywhere.
  CHECK(Ellipsoid{2, 2, 2}.cross_section_m2({3, -1, 2}) == Approx(kPi * 4));
  // On its axes: pi times the product of both radii of curvature.
  const Ellipsoid shape{3, 1.5, 0.5};
  CHECK(shape.cross_section_m2({1, 0, 0}) == Approx(kPi * std::pow(1.5 * 0.5 / 3, 2)));
  CHECK(shape.cross_section_m2({0, -7, 0}) == Approx(kPi * std::pow(3 * 0.5 / 1.5, 2)));
  CHECK(shape.cross_section_m2({0, 0, 2}) == Approx(kPi * std::pow(3 * 1.5 / 0.5, 2)));
  // Summed over all directions it is pi times the surface (each piece of surface is normal to its
  // curvature's share of directions): of a spheroid, 2 pi b^2 (1 + a / (b e) arcsin e).
  const double a = 3;
  const double b = 1;
  const double e = std::sqrt(1 - b * b / (a * a));
  const Ellipsoid spheroid{a, b, b};
  double sum = 0;
  constexpr int kBands = 20000;
  for (int i = 0; i < kBands; ++i) {
    const double along = -1 + 2 * (i + 0.5) / kBands;
    sum += spheroid.cross_section_m2({along, std::sqrt(1 - along * along), 0}) * 4 * kPi / kBands;
  }
  CHECK(sum / kPi == Approx(2 * kPi * b * b * (1 + a / (b * e) * std::asin(e))).epsilon(1e-4));
}

TEST_CASE("Who turns his side to a radar shows more, and who banks, too") {
  const Ellipsoid shape{3, 1.5, 0.5};
  const Local aircraft{0, 0, 1000};
  const Local radar{20000, 0, 1000};
  const double nose = aspect_cross_section_m2(shape, aircraft, {0, 0, 0}, radar);
  const double side = aspect_cross_section_m2(shape, aircraft, {0, 0, kPi / 2}, radar);
  CHECK(nose == Approx(shape.cross_section_m2({1, 0, 0})));
  // Northward is to the left of who flies east.
  CHECK(side == Approx(shape.cross_section_m2({0, -1, 0})));
  CHECK(aspect_cross_section_m2(shape, aircraft, {0.5, 0, kPi / 2}, radar) ==
        Approx(shape.cross_section_m2({0, -std::cos(0.5), std::sin(0.5)})));
}

TEST_CASE("A track is confirmed when m of the last n looks have detected") {
  TrackConfirmation track(2, 3);
  CHECK_FALSE(track.look(true));
  CHECK_FALSE(track.look(false));
  CHECK(track.look(true));
  track.forget();
  CHECK_FALSE(track.look(true));
  CHECK_FALSE(track.look(false));
  CHECK_FALSE(track.look(false));
  CHECK_FALSE(track.look(true));
  CHECK(track.look(true));
}

}  // namespace radar_detection_test
