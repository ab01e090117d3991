#include "navigation/threats/threat_models.hpp"

#include <catch2/catch.hpp>
#include <cmath>

#include "made_terrain.hpp"
#include "skein/error.hpp"

using namespace skein::navigation;
using namespace skein::navigation::testing;
using AE_navigator::Position;

namespace {

const AE_navigator::MissileSite kMissiles{"S", {10000, 10000}, 10, 5000, 0.02};

}  // namespace

TEST_CASE("A detection is as probable as North's formula says") {
  // With no signal hardly more than the false alarms, 13 dB for nine of ten at one in a million.
  CHECK(detection_probability(0, 1e-6) < 1e-4);
  CHECK(detection_probability(std::pow(10, 1.314), 1e-6) == Approx(0.9).margin(0.01));
  CHECK(detection_probability(std::pow(10, 1.12), 1e-6) == Approx(0.5).margin(0.02));
  CHECK(detection_probability(1000, 1e-6) == Approx(1));
  CHECK(detection_probability(10, 1e-4) > detection_probability(10, 1e-6));
  CHECK_THROWS_AS(detection_probability(-1, 0.1), skein::InvalidArgument);
  CHECK_THROWS_AS(detection_probability(NAN, 0.1), skein::InvalidArgument);
  CHECK_THROWS_AS(detection_probability(1, 0), skein::InvalidArgument);
  CHECK_THROWS_AS(detection_probability(1, 1), skein::InvalidArgument);
}

TEST_CASE("At half of the distance a radar's signal is sixteen times as strong") {
  CHECK(signal_to_noise(20, 8000, 8000) == Approx(20));
  CHECK(signal_to_noise(20, 8000, 4000) == Approx(320));
}

TEST_CASE("Several looks detect unless all of them miss") {
  const double looks[] = {0.5, 0.5, 0.2};
  CHECK(cumulative_detection(looks) == Approx(0.8));
  CHECK(cumulative_detection({}) == 0);
}

TEST_CASE("A target comes over the horizon at 4.12 km times the sum of the roots of the heights") {
  CHECK(radar_horizon_m(100, 400) == Approx(4122.5 * 30).epsilon(1e-3));
  CHECK(radar_horizon_m(100, 0) == Approx(radar_horizon_m(0, 100)));
  // Where the ray of the antenna at that distance has sunk onto the ground.
  CHECK(earth_drop_m(radar_horizon_m(100, 0)) == Approx(100));
}

TEST_CASE("Who flies past a missile site survives by the time that he is within range") {
  const Terrain terrain = flat_terrain();
  const MissileThreat threat(terrain, std::span(&kMissiles, 1));
  const double aside = std::hypot(3000, 500 - 10);
  const double inside_m = 2 * std::sqrt(5000.0 * 5000 - aside * aside);
  const Position route[] = {{13000, 2000, 500}, {13000, 9000, 500}, {13000, 18000, 500}};
  CHECK(threat.survival(route, 100) == Approx(std::exp(-0.02 * inside_m / 100)));
  CHECK(threat.survival(route, 200) == Approx(std::sqrt(threat.survival(route, 100))));
  const Position clear[] = {{16000, 2000, 500}, {16000, 18000, 500}};
  CHECK(threat.survival(clear, 100) == 1);
  CHECK(threat.hazard({13000, 10000, 500}) == 0.02);
  CHECK(threat.hazard({16000, 10000, 500}) == 0);
  CHECK_THROWS_AS(threat.survival(route, 0), skein::InvalidArgument);
}

TEST_CASE("Two missile sites must both be survived") {
  const Terrain terrain = flat_terrain();
  const AE_navigator::MissileSite other{"T", {12000, 6000}, 10, 3000, 0.01};
  const AE_navigator::MissileSite both[] = {kMissiles, other};
  const Position route[] = {{11000, 2000, 500}, {13000, 18000, 700}};
  CHECK(MissileThreat(terrain, both).survival(route, 80) ==
        Approx(MissileThreat(terrain, std::span(&kMissiles, 1)).survival(route, 80) *
               MissileThreat(terrain, std::span(&other, 1)).survival(route, 80)));
}

TEST_CASE("A missile site does not reach behind a ridge") {
  const Terrain terrain =
      make_terrain(201, 100, [](double north, double) { return north == 12000 ? 400.0 : 0.0; });
  const MissileThreat threat(terrain, std::span(&kMissiles, 1));
  const Position low[] = {{13000, 2000, 300}, {13000, 18000, 300}};
  CHECK(threat.survival(low, 100) == 1);
  const Position high[] = {{13000, 2000, 900}, {13000, 18000, 900}};
  CHECK(threat.survival(high, 100) < 1);
}
