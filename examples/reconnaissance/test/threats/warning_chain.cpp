#include <catch2/catch.hpp>
#include <cmath>
#include <map>

#include "threats/air_defence_picture.hpp"
#include "threats/radar.hpp"
#include "threats/survival.hpp"

namespace warning_chain_test {

using namespace reconnaissance;

namespace {

constexpr Ellipsoid kShape{1.5, 1.0, 0.4};

/// Two sites, of which the second pops up; each sees a square metre with 0.9 at that distance.
RadarSite site(std::uint32_t emitter, const Local& antenna, double sees_at_m) {
  return {
      .emitter = emitter,
      .antenna = antenna,
      .constant_j_m2_k = 20.8 * 1.380649e-23 * std::pow(sees_at_m, 4),
      .radiated_power_w = 5e8,
      .search = {3.0e9, 0.9e-3, 4},
      .track = {8.7e9, 190e-6, 0},
      .guidance = {9.0e9, 50e-6, 0},
      .zone = {.greatest_range_m = 8000, .greatest_height_m = 5000, .kills_per_s = 0.02},
  };
}

double flat(double, double) { return 0; }

/// What becomes of an emitter that is heard, by the classifiers and their vote.
class Warner {
 public:
  Identification identify(const Emission& emission, const Intercept& intercept) {
    std::vector<Intercept>& burst = bursts_[emission.emitter];
    burst.push_back(intercept);
    std::vector<skein::Opinion<Identification>> opinions{
        {"table", match_table(intercept, receiver_, emitter_library())},
        {"Bayes", classify_bayesian(intercept, receiver_, emitter_library())}};
    if (const auto late = classify_wideband(burst, receiver_, emitter_library())) {
      opinions.push_back({"wideband", *late});
    }
    const auto voted = vote_(opinions);
    return voted ? voted->result : Identification{};
  }

 private:
  WarnerReceiver receiver_;
  skein::Synthesis<Identification> vote_ =
      identification_vote<Identification>(emitter_library().size() + 1);
  std::map<std::uint32_t, std::vector<Intercept>> bursts_;
};

/// When what happened first, in seconds of the flight; not positive: not at all.
struct Flight {
  double heard_s = -1;
  double placed_s = 0;
  double tracked_s = 0;
  double pop_up_placed_s = 0;
  double survival = 1;
  std::vector<Threat> threats;
};

/// North at 60 m/s and 1000 m, past a site 6 km to the east and, from 150 s on, one to the west.
Flight fly(std::uint64_t seed, double pop_up_s) {
  RadarSite popping_up = site(2, {17000, -9000, 10}, 14000);
  popping_up.active_from_s = pop_up_s;
  const RadarSite sites[]{site(1, {14000, 6000, 10}, 12000), popping_up};
  Radar radars[]{Radar(sites[0], seed), Radar(sites[1], seed + 1)};
  Random random(seed + 2);
  Warner warner;
  AirDefencePicture picture{WarnerReceiver()};
  Survival survival;
  Flight flight;
  for (int tick = 0; tick < 50 * 300; ++tick) {
    const double time_s = tick * 0.02;
    const RadarTarget aircraft{{60 * time_s, 0, 1000}, {}, kShape};
    for (int i = 0; i < 2; ++i) {
      const auto emission = radars[i].step(time_s, aircraft, flat);
      survival.pass(hazard_per_s(sites[i], radars[i].mode(), aircraft.place), 0.02);
      if (!emission) continue;
      if (emission->mode != RadarMode::Search && flight.tracked_s == 0) flight.tracked_s = time_s;
      const auto intercept = receive(*emission, aircraft.place, WarnerReceiver(), flat, random);
      if (!intercept) continue;
      if (flight.heard_s < 0) flight.heard_s = time_s;
      picture.hear(*intercept, warner.identify(*emission, *intercept), aircraft.place);
    }
    if (tick % 50 != 0) continue;
    const std::size_t threats = picture.threats().size();
    if (threats >= 1 && flight.placed_s == 0) flight.placed_s = time_s;
    if (threats >= 2 && flight.pop_up_placed_s == 0) flight.pop_up_placed_s = time_s;
  }
  flight.survival = survival.probability();
  flight.threats = picture.threats();
  return flight;
}

}  // namespace

TEST_CASE("A site is heard and placed before it tracks, whatever the seed") {
  for (std::uint64_t seed = 100; seed < 110; ++seed) {
    const Flight flight = fly(seed, 1e9);
    INFO("heard " << flight.heard_s << ", placed " << flight.placed_s << ", tracked "
                  << flight.tracked_s << ", survival " << flight.survival);
    CHECK(flight.placed_s > flight.heard_s);
    CHECK(flight.tracked_s > flight.placed_s);
    REQUIRE(flight.threats.size() == 1);
    CHECK(flight.threats[0].emitter == "short-range site");
    CHECK(std::hypot(flight.threats[0].position.mean[0] - 14000,
                     flight.threats[0].position.mean[1] - 6000) < 300);
    // It is flown past within its zone for most of three minutes.
    CHECK(flight.survival < 0.9);
  }
}

TEST_CASE("A site that pops up is placed by bearings and power within 20 s") {
  for (std::uint64_t seed = 200; seed < 210; ++seed) {
    const Flight flight = fly(seed, 150);
    INFO("placed after " << flight.pop_up_placed_s - 150);
    CHECK(flight.pop_up_placed_s > 150);
    CHECK(flight.pop_up_placed_s < 170);
    REQUIRE(flight.threats.size() == 2);
    for (const Threat& threat : flight.threats) {
      const bool first = threat.position.mean[1] > 0;
      CHECK(std::hypot(threat.position.mean[0] - (first ? 14000 : 17000),
                       threat.position.mean[1] - (first ? 6000 : -9000)) < 600);
    }
  }
}

}  // namespace warning_chain_test
