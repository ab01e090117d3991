#include "threats/survival.hpp"

#include <catch2/catch.hpp>

namespace survival_test {

using namespace reconnaissance;

namespace {

const RadarSite kSite{
    .emitter = 1,
    .antenna = {0, 0, 0},
    .constant_j_m2_k = 1,
    .radiated_power_w = 1,
    .search = {},
    .track = {},
    .guidance = {},
    .zone = {.greatest_range_m = 5000, .greatest_height_m = 4000, .kills_per_s = 0.02},
};

}  // namespace

TEST_CASE("Who crosses a zone survives by the exponential of his time in it") {
  // A chord 3 km aside and 1 km up: 2 sqrt(5^2 - 3^2 - 1^2) km at 60 m/s.
  constexpr double kSpeed_m_s = 60;
  constexpr double kTick_s = 0.02;
  Survival survival;
  for (double north = -8000; north < 8000; north += kSpeed_m_s * kTick_s) {
    survival.pass(hazard_per_s(kSite, RadarMode::Guidance, {north, 3000, 1000}), kTick_s);
  }
  const double seconds = 2 * std::sqrt(15.0) * 1000 / kSpeed_m_s;
  CHECK(survival.probability() == Approx(std::exp(-0.02 * seconds)).epsilon(5e-4));
}

TEST_CASE("Only a site that guides a missile endangers, and only within its zone") {
  const Local near{2000, 0, 1000};
  CHECK(hazard_per_s(kSite, RadarMode::Guidance, near) == 0.02);
  CHECK(hazard_per_s(kSite, RadarMode::Track, near) == 0);
  CHECK(hazard_per_s(kSite, RadarMode::Search, near) == 0);
  CHECK(hazard_per_s(kSite, RadarMode::Guidance, {2000, 0, 4100}) == 0);
  CHECK(hazard_per_s(kSite, RadarMode::Guidance, {5000, 0, 1000}) == 0);
}

}  // namespace survival_test
