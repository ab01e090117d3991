#include "threats/radar.hpp"

#include <catch2/catch.hpp>
#include <cmath>
#include <map>
#include <vector>

namespace radar_test {

using namespace reconnaissance;

namespace {

constexpr double kTick_s = 0.02;
constexpr Ellipsoid kShape{1.5, 1.0, 0.4};

/// Sees a square metre at 15 km with a probability of 0.9.
RadarSite site() {
  return {
      .emitter = 7,
      .antenna = {0, 0, 10},
      .constant_j_m2_k = 20.8 * 1.380649e-23 * std::pow(15000, 4),
      .radiated_power_w = 1e9,
      .search = {3.0e9, 1e-3, 4},
      .track = {9.0e9, 2e-4, 0},
      .guidance = {9.1e9, 5e-5, 0},
      .zone = {.least_range_m = 1000,
               .greatest_range_m = 8000,
               .least_height_m = 30,
               .greatest_height_m = 5000,
               .kills_per_s = 0.02},
  };
}

double flat(double, double) { return 0; }

/// At a distance with the side towards the radar, which shows pi (1.5 * 0.4 / 1)^2 = 1.13 m2.
RadarTarget at(double north_m, double height_m = 800) {
  return {{north_m, 0, height_m}, {0, 0, 1.5707963267948966}, kShape};
}

/// What the radar transmits while the target stays where it is.
std::vector<Emission> watch(Radar& radar, double from_s, double until_s, const RadarTarget& target,
                            const GroundHeight& ground = flat) {
  std::vector<Emission> emissions;
  const int first = static_cast<int>(std::lround(from_s / kTick_s));
  const int last = static_cast<int>(std::lround(until_s / kTick_s));
  for (int tick = first; tick < last; ++tick) {
    if (const auto emission = radar.step(tick * kTick_s, target, ground)) {
      emissions.push_back(*emission);
    }
  }
  return emissions;
}

}  // namespace

TEST_CASE("A radar sees less the further the target is, and nothing of what the ground hides") {
  CHECK(look_probability(site(), at(15000), flat) == Approx(0.95).margin(0.04));
  CHECK(look_probability(site(), at(5000), flat) > 0.9999);
  CHECK(look_probability(site(), at(40000), flat) < 0.01);
  const auto ridge = [](double north_m, double) {
    return std::abs(north_m - 3000) < 100 ? 1000.0 : 0.0;
  };
  CHECK(look_probability(site(), at(5000), ridge) == 0);
}

TEST_CASE("A radar that pops up is silent before, and then emits twice a second") {
  RadarSite popping_up = site();
  popping_up.active_from_s = 10;
  Radar radar(popping_up, 1);
  CHECK(watch(radar, 0, 10, at(60000)).empty());
  CHECK(radar.mode() == RadarMode::Off);
  const auto emissions = watch(radar, 10, 20, at(60000));
  CHECK(emissions.size() == 20);
  for (const Emission& emission : emissions) {
    CHECK(emission.mode == RadarMode::Search);
    CHECK(emission.waveform.scan_s == 4);
    CHECK(emission.emitter == 7);
  }
}

TEST_CASE("From search by two of three looks to a track, and after its reaction to guidance") {
  Radar radar(site(), 2);
  // Looks after each turn of the antenna of 4 s: the second, at 8 s, confirms.
  std::map<RadarMode, std::vector<double>> times;
  for (const Emission& emission : watch(radar, 0, 30, at(5000))) {
    times[emission.mode].push_back(emission.time_s);
  }
  CHECK(times[RadarMode::Track].front() == Approx(8));
  CHECK(times[RadarMode::Guidance].front() == Approx(16));
  CHECK(times[RadarMode::Track].size() == 40);      // 8 s at 5 Hz.
  CHECK(times[RadarMode::Guidance].size() == 140);  // 14 s at 10 Hz.
}

TEST_CASE("A change of the mode is emitted at once") {
  RadarSite slower = site();
  slower.search.scan_s = 4.3;
  Radar radar(slower, 2);
  for (const Emission& emission : watch(radar, 0, 10, at(5000))) {
    if (emission.mode == RadarMode::Search) continue;
    CHECK(emission.time_s == Approx(8.6));
    break;
  }
  CHECK(radar.mode() == RadarMode::Track);
}

TEST_CASE("Outside of the weapon's zone a radar tracks, and does not guide") {
  Radar radar(site(), 3);
  watch(radar, 0, 60, at(9000));
  CHECK(radar.mode() == RadarMode::Track);
  watch(radar, 60, 61, at(7000));
  CHECK(radar.mode() == RadarMode::Guidance);
  watch(radar, 61, 62, at(9000));
  CHECK(radar.mode() == RadarMode::Track);
  watch(radar, 62, 63, at(7000, 20));
  CHECK(radar.mode() == RadarMode::Track);
}

TEST_CASE("A target that goes behind a ridge is lost after five missed looks") {
  Radar radar(site(), 4);
  watch(radar, 0, 30, at(5000));
  REQUIRE(radar.mode() == RadarMode::Guidance);
  const auto wall = [](double north_m, double) {
    return std::abs(north_m - 3000) < 100 ? 2000.0 : 0.0;
  };
  watch(radar, 30, 30.3, at(5000), wall);
  CHECK(radar.mode() == RadarMode::Guidance);
  CHECK(radar.last_detection_probability() == 0);
  watch(radar, 30.3, 30.7, at(5000), wall);
  CHECK(radar.mode() == RadarMode::Search);
  // Detections of before do not confirm anew.
  for (const Emission& emission : watch(radar, 30.7, 60, at(5000), wall)) {
    CHECK(emission.mode == RadarMode::Search);
  }
}

TEST_CASE("The same seed gives the same emissions, another one others") {
  const auto modes = [](std::uint64_t seed) {
    Radar radar(site(), seed);
    std::vector<RadarMode> seen;
    for (const Emission& emission : watch(radar, 0, 200, at(17000))) seen.push_back(emission.mode);
    return seen;
  };
  CHECK(modes(5) == modes(5));
  CHECK(modes(5) != modes(6));
}

TEST_CASE("A radar that lies in wait is silent until the target is near, and not any more after") {
  RadarSite waiting = site();
  waiting.active_from_s = 100;
  waiting.silent_beyond_m = 9000;
  Radar radar(waiting, 1);
  CHECK(watch(radar, 0, 50, at(5000)).empty());  // it is not there yet
  CHECK(watch(radar, 100, 150, at(9100)).empty());
  CHECK(radar.mode() == RadarMode::Off);
  const auto emissions = watch(radar, 150, 160, at(8900));
  REQUIRE_FALSE(emissions.empty());
  CHECK(emissions.front().time_s == Approx(150));
  CHECK_FALSE(watch(radar, 160, 200, at(40000)).empty());
  CHECK(radar.mode() == RadarMode::Search);
}

}  // namespace radar_test
