#include "threats/emitter_location.hpp"

#include <catch2/catch.hpp>
#include <cmath>
#include <utility>
#include <vector>

#include "random.hpp"

namespace emitter_location_test {

using namespace reconnaissance;
using skein::fusion::chi_square_quantile;
using skein::fusion::Estimate;
using skein::fusion::nees;

namespace {

constexpr double kSigma_rad = 0.035;
constexpr int kRuns = 100;

Bearing bearing(const Local& from, const Local& emitter, double error_rad = 0) {
  return {from, course_between_rad(from, emitter) + error_rad, kSigma_rad};
}

/// Two bearings a second from an aircraft that flies north at 60 m/s from the origin.
std::vector<Bearing> fly(double seconds, const Local& emitter, Random& random) {
  std::vector<Bearing> bearings;
  for (int i = 0; i < 2 * seconds; ++i) {
    bearings.push_back(bearing({30.0 * i, 0, 1000}, emitter, kSigma_rad * random.normal()));
  }
  return bearings;
}

BearingFilter filter(const std::vector<Bearing>& bearings) {
  BearingFilter filter(bearings[0], 3000, 60000);
  for (std::size_t i = 1; i < bearings.size(); ++i) filter.update(bearings[i]);
  return filter;
}

/// A direction, and a distance between 3 and 60 km of which each octave is equally probable, as the
/// filter is told.
std::pair<double, double> anywhere(Random& random) {
  const double range_m = 3000 * std::pow(20, random.uniform());
  return {0.3 + 2.4 * random.uniform(), range_m};
}

Local at(double bearing_rad, double range_m) {
  return {range_m * std::cos(bearing_rad), range_m * std::sin(bearing_rad), 0};
}

std::vector<double> truth(const Local& emitter) { return {emitter.north_m, emitter.east_m}; }

/// The bounds of a mean NEES of two quantities over all runs, with 95 %.
double bound(double probability) { return chi_square_quantile(probability, 2 * kRuns) / kRuns; }

}  // namespace

TEST_CASE("Two bearings that cross at a right angle are as good as each alone across its line") {
  const Local emitter{10000, 0, 0};
  const std::vector<Bearing> bearings{bearing({0, 0, 1000}, emitter),
                                      bearing({10000, -5000, 1000}, emitter)};
  const auto found = triangulate(bearings);
  REQUIRE(found);
  CHECK(found->mean[0] == Approx(10000));
  CHECK(found->mean[1] == Approx(0).margin(0.01));
  // Each line is uncertain by its distance times sigma.
  CHECK(found->covariance[0] == Approx(std::pow(5000 * kSigma_rad, 2)));
  CHECK(found->covariance[3] == Approx(std::pow(10000 * kSigma_rad, 2)));
  CHECK(found->covariance[1] == Approx(0).margin(1));
}

TEST_CASE("Bearings that do not say where the emitter is give no place") {
  const Local emitter{5000, 20000, 0};
  Random random(1);
  CHECK_FALSE(triangulate(std::vector{bearing({0, 0, 0}, emitter)}));
  // Twice from the same place.
  CHECK_FALSE(triangulate(std::vector{bearing({0, 0, 0}, emitter), bearing({0, 0, 0}, emitter)}));
  // 60 m of flight at 20 km.
  CHECK_FALSE(triangulate(fly(1, emitter, random)));
  // Lines that diverge meet behind.
  CHECK_FALSE(triangulate(
      std::vector{Bearing{{0, 0, 0}, 2.0, kSigma_rad}, Bearing{{5000, 0, 0}, 1.0, kSigma_rad}}));
  // So do the opposites of these, whose differences cancel out.
  std::vector<Bearing> opposite;
  for (const Local& from : {Local{0, 0, 0}, Local{5000, 0, 0}}) {
    for (const double error : {0.01, -0.01}) {
      opposite.push_back(bearing(from, {5000, 9000, 0}, M_PI + error));
    }
  }
  CHECK_FALSE(triangulate(opposite));
  // Bearings on both sides of north.
  CHECK(triangulate(std::vector{Bearing{{0, 0, 0}, 0.3, kSigma_rad},
                                Bearing{{0, 5000, 0}, -0.3 + 2 * M_PI, kSigma_rad}}));
}

TEST_CASE("Triangulation is consistent: its NEES is within the bounds") {
  Random random(21);
  double sum = 0;
  for (int run = 0; run < kRuns; ++run) {
    const Local emitter{4000 + 2000 * random.uniform(), 6000 + 8000 * random.uniform(), 0};
    const auto found = triangulate(fly(120, emitter, random));
    REQUIRE(found);
    sum += nees(*found, truth(emitter));
  }
  INFO("NEES " << sum / kRuns);
  CHECK(sum / kRuns > bound(0.025));
  CHECK(sum / kRuns < bound(0.975));
}

TEST_CASE("The filter is consistent from the first bearings until it knows the place") {
  for (const double seconds : {10.0, 30.0, 60.0, 120.0, 240.0}) {
    Random random(static_cast<std::uint64_t>(22 + seconds));
    double sum = 0;
    for (int run = 0; run < kRuns; ++run) {
      const auto [bearing_rad, range_m] = anywhere(random);
      const Local emitter = at(bearing_rad, range_m);
      sum += nees(filter(fly(seconds, emitter, random)).state(), {bearing_rad, 1000 / range_m});
    }
    INFO("after " << seconds << " s NEES " << sum / kRuns);
    CHECK(sum / kRuns > bound(0.025));
    CHECK(sum / kRuns < bound(0.975));
  }
}

TEST_CASE("Where the filter knows the place its north and east are consistent, too") {
  Random random(25);
  double sum = 0;
  int runs = 0;
  while (runs < kRuns) {
    const auto [bearing_rad, range_m] = anywhere(random);
    const Local emitter = at(bearing_rad, range_m);
    const BearingFilter heard = filter(fly(120, emitter, random));
    if (heard.relative_range_sigma() > 0.3) continue;
    sum += nees(heard.position(), truth(emitter));
    ++runs;
  }
  INFO("NEES " << sum / kRuns);
  CHECK(sum / kRuns > bound(0.025));
  CHECK(sum / kRuns < bound(0.975));
}

TEST_CASE("An emitter that is flown towards is not placed where the aircraft is") {
  Random random(26);
  int placed = 0;
  for (int run = 0; run < 30; ++run) {
    const Local emitter{31'000, 3000 * random.uniform(), 0};
    const auto bearings = fly(300, emitter, random);
    for (std::size_t count = 20; count <= bearings.size(); count += 20) {
      const std::span heard = std::span(bearings).first(count);
      const double here_m = heard.back().from.north_m;
      for (const auto& found : {filter_bearings(heard, 17'000, 57'000), triangulate(heard)}) {
        if (!found) continue;
        ++placed;
        INFO("run " << run << " from " << here_m << ": " << found->mean[0] << ' '
                    << found->mean[1]);
        REQUIRE(std::hypot(found->mean[0] - here_m, found->mean[1]) > 0.2 * (31'000 - here_m));
      }
    }
  }
  CHECK(placed > 200);
}

TEST_CASE("The filter is as sharp as all bearings together allow") {
  Random random(23);
  for (int run = 0; run < kRuns; ++run) {
    const Local emitter{6000, 8000, 0};
    const auto bearings = fly(180, emitter, random);
    const Estimate filtered = filter(bearings).position();
    const auto possible = triangulate(bearings);
    REQUIRE(possible);
    CHECK(filtered.covariance[0] == Approx(possible->covariance[0]).epsilon(0.02));
    CHECK(filtered.covariance[3] == Approx(possible->covariance[3]).epsilon(0.02));
    const double apart =
        std::hypot(filtered.mean[0] - possible->mean[0], filtered.mean[1] - possible->mean[1]);
    CHECK(apart < 10);
  }
}

TEST_CASE("A bearing of another emitter does not fit the filter, one of the same does") {
  Random random(24);
  const Local emitter{6000, 8000, 0};
  const BearingFilter heard = filter(fly(60, emitter, random));
  const Local here{3600, 0, 1000};
  CHECK(heard.innovation(bearing(here, emitter)).squared() < 1);
  CHECK(heard.innovation(bearing(here, emitter, 0.3)).squared() > 50);
  CHECK(heard.innovation(bearing(here, emitter, 2 * M_PI)).squared() < 1);
  // A bearing's own variance, and little more.
  CHECK(heard.innovation(bearing(here, emitter)).variance_rad2 ==
        Approx(kSigma_rad * kSigma_rad).epsilon(0.1));
}

}  // namespace emitter_location_test
