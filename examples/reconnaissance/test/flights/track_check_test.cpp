// The check of recorded tracks itself: it finds what is wrong.
#include "track_check.hpp"

#include <unistd.h>

#include <catch2/catch.hpp>
#include <cmath>
#include <fstream>
#include <functional>
#include <string>

using namespace skein::test;

namespace {

struct Place {
  double north_m, east_m, height_m, above_ground_m;
};

/// Writes what a function of time makes, ten times a second, and judges it.
template <class Judge>
auto judge_by(const Judge& judge, double seconds, const std::function<Place(double)>& own,
              const std::function<Place(double)>& other = {}) {
  const auto file = std::filesystem::temp_directory_path() /
                    ("track_check_test_" + std::to_string(getpid()) + ".csv");
  {
    std::ofstream stream(file);
    stream.precision(12);
    stream << "time_s,aircraft,latitude_deg,longitude_deg,height_m,height_above_ground_m\n";
    // At the equator: 110574 m and 111320 m a degree.
    const auto write = [&](double time_s, int aircraft, const Place& place) {
      stream << time_s << ',' << aircraft << ',' << place.north_m / 110574.3 << ','
             << place.east_m / 111319.5 << ',' << place.height_m << ',' << place.above_ground_m
             << '\n';
    };
    for (int i = 0; i <= seconds * 10; ++i) {
      write(i / 10.0, 0, own(i / 10.0));
      if (other) write(i / 10.0, 1, other(i / 10.0));
    }
  }
  const auto judged = judge(file);
  std::filesystem::remove(file);
  return judged;
}

TrackExtremes judge(double seconds, const std::function<Place(double)>& own,
                    const std::function<Place(double)>& other = {}) {
  return judge_by(extremes_of, seconds, own, other);
}

}  // namespace

TEST_CASE("the bank that a track shows is that of its circle, its climb that of its slope") {
  // 60 m/s on a circle of 787 m: 25 degrees.
  const auto circling = judge(60, [](double t) {
    const double angle = 60 * t / 787;
    return Place{787 * std::sin(angle), 787 * std::cos(angle), 900, 700};
  });
  CHECK(circling.greatest_bank_deg == Approx(25).margin(0.5));
  CHECK(circling.greatest_climb_deg == Approx(0).margin(0.01));
  const auto climbing = judge(60, [](double t) { return Place{60 * t, 0, 500 + 6 * t, 300}; });
  CHECK(climbing.greatest_climb_deg == Approx(std::atan(0.1) * 57.29578).margin(0.05));
  CHECK(climbing.greatest_bank_deg == Approx(0).margin(0.01));
  CHECK(climbing.flown_m == Approx(3600).epsilon(0.001));
}

TEST_CASE("clearance counts away from where the track begins") {
  const auto low_where = [](double low_from_m) {
    return judge(200, [=](double t) {
      const double north = 60 * t;
      return Place{north, 0, 500, north > low_from_m && north < low_from_m + 500 ? 90.0 : 300.0};
    });
  };
  CHECK(low_where(2000).least_clearance_m == 300);
  CHECK(low_where(8000).least_clearance_m == 90);
}

TEST_CASE(
    "who comes within 0.66 nautical miles and 450 ft of another is not well clear for so long") {
  const auto own = [](double t) { return Place{60 * t, 0, 900, 700}; };
  const auto passing = [&](double aside_m, double above_m) {
    return judge(100, own, [=](double t) {
      return Place{6000 - 60 * t, aside_m, 900 + above_m, 700};
    });
  };
  CHECK(passing(1300, 0).longest_not_well_clear_s == 0);
  CHECK(passing(300, 140).longest_not_well_clear_s == 0);
  // A chord of 2370 m, at 120 m/s.
  CHECK(passing(300, 100).longest_not_well_clear_s == Approx(19.75).margin(0.3));
}

TEST_CASE("a track tells how a place was passed, how finely it could be seen, and for how long") {
  // Eastwards at 60 m/s, 700 m north of the place, 750 m above it.
  const auto own = [](double t) { return Place{700, 60 * t - 3000, 930, 750}; };
  const Pass pass = judge_by([](const auto& file) { return pass_by(file, 0, 0); }, 100, own);
  CHECK(pass.beside_m == Approx(700).margin(5));
  CHECK(pass.above_ground_m == 750);
  // The slant range is 1026 m, and each pixel longer by its share of the height.
  CHECK(pass.sample_m(1e-4) == Approx(1026 * 1e-4 * 1026 / 750).epsilon(0.01));
  const auto within = [&](double distance_m) {
    return judge_by([&](const auto& file) { return seconds_within(file, 0, 0, distance_m); }, 100,
                    own);
  };
  CHECK(within(600) == 0);
  // A chord of 1428 m.
  CHECK(within(1000) == Approx(1428 / 60.0).margin(0.3));
}
