#include "sensing/camera.hpp"

#include <catch2/catch.hpp>
#include <cmath>
#include <numbers>

#include "random.hpp"

namespace camera_test {

using namespace reconnaissance;

namespace {

constexpr double kPi = std::numbers::pi;
constexpr double kDegree = kPi / 180;
const Camera kCamera{4 * kDegree, 3 * kDegree, 1920, 1080};

double flat(double, double) { return 0; }

/// Level flight with a heading, looking so far below the horizon.
CameraPose looking_down(double height_m, double below_rad, double azimuth_rad = 0,
                        double heading_rad = 0) {
  return {{0, 0, height_m}, {0, 0, heading_rad}, {azimuth_rad, -below_rad}};
}

}  // namespace

TEST_CASE("Straight down the footprint is a rectangle of the height times twice the tangents") {
  const auto seen = footprint(looking_down(2000, kPi / 2), kCamera, flat);
  REQUIRE(seen);
  const double width = 2 * 2000 * std::tan(2 * kDegree);
  const double depth = 2 * 2000 * std::tan(1.5 * kDegree);
  CHECK(seen->area_m2() == Approx(width * depth).epsilon(1e-4));
  // The upper left corner is ahead and to the left.
  CHECK(seen->corners[0].north_m == Approx(depth / 2).epsilon(1e-4));
  CHECK(seen->corners[0].east_m == Approx(-width / 2).epsilon(1e-4));
  CHECK(seen->corners[2].north_m == Approx(-depth / 2).epsilon(1e-4));
  CHECK(seen->centre.north_m == Approx(0).margin(0.01));
}

TEST_CASE("Obliquely the footprint's near and far edges are where the tangents say") {
  // To the right of who flies east, which is south.
  const auto seen = footprint(looking_down(1000, 30 * kDegree, kPi / 2, kPi / 2), kCamera, flat);
  REQUIRE(seen);
  const double curvature = 3e-4;  // 0.2 m of 1.7 km, at 30 degrees 0.4 m further.
  CHECK(seen->centre.north_m == Approx(-1000 / std::tan(30 * kDegree)).epsilon(curvature));
  CHECK(seen->centre.east_m == Approx(0).margin(0.01));
  const double far = 1000 / std::tan(28.5 * kDegree);
  const double near = 1000 / std::tan(31.5 * kDegree);
  CHECK(seen->corners[0].north_m == Approx(-far).epsilon(curvature));
  CHECK(seen->corners[3].north_m == Approx(-near).epsilon(curvature));
  // Its left is east.
  CHECK(seen->corners[0].east_m > 0);
  CHECK(seen->corners[1].east_m == Approx(-seen->corners[0].east_m));
  // A trapezoid: widths by the ray through the corner, whose forward part is
  // cos 1.5 deg of the slant range.
  const double far_width =
      2 * std::tan(2 * kDegree) * (1000 / std::sin(28.5 * kDegree)) * std::cos(1.5 * kDegree);
  CHECK(2 * seen->corners[0].east_m == Approx(far_width).epsilon(curvature));
}

TEST_CASE("A camera that sees the sky has no footprint") {
  CHECK_FALSE(footprint(looking_down(1000, 1 * kDegree), kCamera, flat));
  CHECK_FALSE(ground_sample(looking_down(1000, -1 * kDegree), kCamera, {}, flat));
}

TEST_CASE("In the middle the ground sample is the slant range times a pixel's angle") {
  // Closed forms: Leachtenauer and Driggers, 2001.
  for (const double below : {90.0, 60.0, 30.0, 10.0}) {
    const auto sample = ground_sample(looking_down(1000, below * kDegree), kCamera, {}, flat);
    REQUIRE(sample);
    const double slant = 1000 / std::sin(below * kDegree);
    const double column = 2 * std::tan(2 * kDegree) / 1920;
    const double row = 2 * std::tan(1.5 * kDegree) / 1080;
    const double curvature = below < 20 ? 4e-3 : 4e-4;
    CHECK(sample->slant_range_m == Approx(slant).epsilon(curvature));
    CHECK(sample->grazing_rad == Approx(below * kDegree).epsilon(curvature));
    CHECK(sample->across_columns_m == Approx(slant * column).epsilon(curvature));
    CHECK(sample->across_rows_m ==
          Approx(slant * row / std::sin(below * kDegree)).epsilon(2 * curvature));
    CHECK(sample->distance_m() == sample->across_rows_m);
  }
}

TEST_CASE("At each point of the image the ground sample is the distance of neighbouring pixels") {
  const auto hills = [](double north_m, double east_m) {
    return 100 * std::sin(north_m / 900) + 60 * std::cos(east_m / 700);
  };
  Random random(41);
  const auto apart = [](const Local& a, const Local& b) { return ned_between(a, b).norm(); };
  for (int run = 0; run < 100; ++run) {
    const CameraPose pose{{0, 0, 1500},
                          {0.5 * random.normal(), 0.1 * random.normal(), 6 * random.uniform()},
                          {6 * random.uniform(), -(0.4 + random.uniform())}};
    const ImagePoint point{0.03 * (2 * random.uniform() - 1), 0.02 * (2 * random.uniform() - 1)};
    const auto sample = ground_sample(pose, kCamera, point, hills);
    if (!sample || sample->grazing_rad < 0.3) continue;
    // Ten pixels to each side.
    const double column = 2 * std::tan(2 * kDegree) / 1920;
    const double row = 2 * std::tan(1.5 * kDegree) / 1080;
    const auto left = ground_at(pose, {point.right - 10 * column, point.down}, hills);
    const auto right = ground_at(pose, {point.right + 10 * column, point.down}, hills);
    const auto above = ground_at(pose, {point.right, point.down - 10 * row}, hills);
    const auto below = ground_at(pose, {point.right, point.down + 10 * row}, hills);
    REQUIRE((left && right && above && below));
    CHECK(apart(*left, *right) / 20 == Approx(sample->across_columns_m).epsilon(0.01));
    CHECK(apart(*above, *below) / 20 == Approx(sample->across_rows_m).epsilon(0.01));
  }
}

TEST_CASE("Whatever the attitude, the gimbal brings a place into the middle of the image") {
  Random random(42);
  for (int run = 0; run < 100; ++run) {
    const Local camera{1000 * random.normal(), 1000 * random.normal(), 2000};
    const Local place{3000 * random.normal(), 3000 * random.normal(), 100};
    const Attitude attitude{0.4 * random.normal(), 0.2 * random.normal(), 6 * random.uniform()};
    const CameraPose pose{camera, attitude, point_at(camera, attitude, place)};
    const auto point = in_image(pose, kCamera, place);
    REQUIRE(point);
    CHECK(point->right == Approx(0).margin(1e-9));
    CHECK(point->down == Approx(0).margin(1e-9));
    const auto seen = ground_at(pose, {}, [](double, double) { return 100.0; });
    REQUIRE(seen);
    CHECK(seen->north_m == Approx(place.north_m).margin(0.1));
    CHECK(seen->east_m == Approx(place.east_m).margin(0.1));
  }
  // Level, to the right and down.
  const GimbalAngles angles = point_at({0, 0, 1000}, {}, {0, 1000, 0});
  CHECK(angles.azimuth_rad == Approx(kPi / 2));
  CHECK(angles.elevation_rad == Approx(-kPi / 4).epsilon(1e-3));
  // A right bank of 45 degrees turns that place into the plane of the wings.
  CHECK(point_at({0, 0, 1000}, {kPi / 4, 0, 0}, {0, 1000, 0}).elevation_rad ==
        Approx(0).margin(1e-3));
}

TEST_CASE("A target is seen in the frame and in the open only") {
  const Local camera{0, 0, 1000};
  const Local target{2000, 0, 0};
  CameraPose pose{camera, {}, point_at(camera, {}, target)};
  const auto sample = ground_sample_of(pose, kCamera, target, flat);
  REQUIRE(sample);
  CHECK(sample->slant_range_m == Approx(std::hypot(2000, 1000)).epsilon(1e-3));
  const auto ridge = [](double north_m, double) {
    return std::max(0.0, 600 - std::abs(north_m - 1400));
  };
  CHECK_FALSE(ground_sample_of(pose, kCamera, target, ridge));
  pose.gimbal.azimuth_rad += 2.4 * kDegree;  // 2.1 degrees in the image.
  CHECK_FALSE(ground_sample_of(pose, kCamera, target, flat));
  // In the opposite direction.
  const GimbalAngles ahead = point_at(camera, {}, target);
  pose.gimbal = {ahead.azimuth_rad + kPi, -ahead.elevation_rad};
  CHECK_FALSE(in_image(pose, kCamera, target));
}

}  // namespace camera_test
