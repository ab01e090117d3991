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
  CHECK(survival.expected_kills() == Approx(0.02 * seconds).epsilon(5e-4));
  CHECK(survival.probability() == Approx(std::exp(-0.02 * seconds)).epsilon(1e-3));
}

TEST_CASE("Only a site that guides a missile endangers, and only within its zone") {
  const Local near{2000, 0, 1000};
  CHECK(hazard_per_s(kSite, RadarMode::Guidance, near) == 0.02);
  CHECK(hazard_per_s(kSite, RadarMode::Track, near) == 0);
  CHECK(hazard_per_s(kSite, RadarMode::Search, near) == 0);
  CHECK(hazard_per_s(kSite, RadarMode::Guidance, {2000, 0, 4100}) == 0);
  CHECK(hazard_per_s(kSite, RadarMode::Guidance, {5000, 0, 1000}) == 0);
}

TEST_CASE("A site appears as often as its probability says, within its time") {
  Random random(8);
  int appeared = 0;
  double sum = 0;
  constexpr int kRuns = 10000;
  for (int run = 0; run < kRuns; ++run) {
    if (const auto time = draw_appearance_s({0.7, 300, 500}, random)) {
      ++appeared;
      sum += *time;
      REQUIRE(*time >= 300);
      REQUIRE(*time < 500);
    }
  }
  // Four standard errors.
  CHECK(static_cast<double>(appeared) / kRuns == Approx(0.7).margin(0.019));
  CHECK(sum / appeared == Approx(400).margin(2.8));
}

TEST_CASE("The survival of a possible site is that of both cases by their probability") {
  CHECK(survival_if_it_appears(0, 3) == 1);
  CHECK(survival_if_it_appears(1, 3) == Approx(std::exp(-3)));
  CHECK(survival_if_it_appears(0.25, 3) == Approx(0.75 + 0.25 * std::exp(-3)));
}

}  // namespace survival_test
