#include "threats/warner_receiver.hpp"

#include <catch2/catch.hpp>
#include <cmath>
#include <numbers>

namespace warner_receiver_test {

using namespace reconnaissance;

namespace {

const Emission kEmission{1, 12, {10000, 10000, 20}, RadarMode::Track, {9e9, 2e-4, 0}, 1e6};

double flat(double, double) { return 0; }

}  // namespace

TEST_CASE("A warner receives by the square of the range what Friis' formula says") {
  // 20 log10(4 pi R / lambda): 131.5 dB of free space at 10 GHz and 9 km (ITU-R P.525:
  // 92.4 + 20 log10(GHz) + 20 log10(km)).
  const double loss_db = -10 * std::log10(received_power_w(1, 10e9, 9000));
  CHECK(loss_db == Approx(92.45 + 20 + 20 * std::log10(9)).margin(0.01));
  CHECK(received_power_w(1, 9e9, 5000) == Approx(4 * received_power_w(1, 9e9, 10000)));
}

TEST_CASE("A warner's bearings scatter about the true one as it says") {
  Random random(1);
  const WarnerReceiver receiver;
  constexpr int kRuns = 4000;
  double sum = 0;
  double squares = 0;
  for (int run = 0; run < kRuns; ++run) {
    const auto intercept = receive(kEmission, {0, 20000, 800}, receiver, flat, random);
    REQUIRE(intercept);
    const double error = intercept->bearing_rad + std::numbers::pi / 4;  // North-west.
    sum += error;
    squares += error * error;
  }
  CHECK(sum / kRuns == Approx(0).margin(4 * 0.035 / std::sqrt(kRuns)));
  CHECK(std::sqrt(squares / kRuns) == Approx(0.035).epsilon(0.05));
}

TEST_CASE(
    "A warner whose antennas are turned is wrong by the same in each bearing, and does not say "
    "so") {
  Random random(1);
  WarnerReceiver turned;
  turned.bearing_bias_rad = 0.1;
  constexpr int kRuns = 400;
  double sum = 0;
  for (int run = 0; run < kRuns; ++run) {
    const auto intercept = receive(kEmission, {0, 20000, 800}, turned, flat, random);
    REQUIRE(intercept);
    CHECK(intercept->bearing_sigma_rad == turned.bearing_sigma_rad);
    sum += intercept->bearing_rad + std::numbers::pi / 4;
  }
  CHECK(sum / kRuns == Approx(0.1).margin(4 * 0.035 / std::sqrt(kRuns)));
}

TEST_CASE("A warner measures the waveform, and keeps bearings between -pi and pi") {
  Random random(2);
  bool west = false;
  bool east = false;
  for (int run = 0; run < 100; ++run) {
    const auto intercept = receive(kEmission, {30000, 10000, 800}, WarnerReceiver(), flat, random);
    REQUIRE(intercept);
    CHECK(std::abs(intercept->bearing_rad) <= std::numbers::pi);
    CHECK(std::abs(intercept->bearing_rad) > 3);
    (intercept->bearing_rad > 0 ? east : west) = true;
    CHECK(intercept->waveform.radio_frequency_hz == Approx(9e9).margin(5 * 20e6));
    CHECK(intercept->waveform.pulse_interval_s == Approx(2e-4).margin(5 * 4e-6));
    CHECK(intercept->time_s == 12);
  }
  CHECK((west && east));
}

TEST_CASE("A warner hears nothing from behind a ridge, and nothing too weak") {
  Random random(3);
  const auto ridge = [](double north_m, double) {
    return std::abs(north_m - 5000) < 200 ? 1500.0 : 0.0;
  };
  const Local aircraft{0, 10000, 800};
  CHECK(receive(kEmission, aircraft, WarnerReceiver(), flat, random));
  CHECK_FALSE(receive(kEmission, aircraft, WarnerReceiver(), ridge, random));
  WarnerReceiver deaf;
  deaf.sensitivity_w = 1e-6;
  CHECK_FALSE(receive(kEmission, aircraft, deaf, flat, random));
}

TEST_CASE("Distances by power scatter about the true one as their interval says") {
  Random random(4);
  const Local aircraft{0, 10000, 800};
  const double range_m = slant_range_m(aircraft, kEmission.antenna);
  constexpr int kRuns = 4000;
  double normalised = 0;
  for (int run = 0; run < kRuns; ++run) {
    const auto intercept = receive(kEmission, aircraft, WarnerReceiver(), flat, random);
    REQUIRE(intercept);
    const auto [least, greatest] = distance_by_power_m(intercept->power_w, 1e6, 9e9, 3);
    const double error = std::log(std::sqrt(least * greatest) / range_m);
    normalised += error * error / (std::pow(std::log(greatest / least), 2) / 12);
  }
  CHECK(normalised / kRuns == Approx(1).margin(4 * std::sqrt(2.0 / kRuns)));
}

}  // namespace warner_receiver_test
