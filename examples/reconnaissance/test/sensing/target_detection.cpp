#include "sensing/target_detection.hpp"

#include <catch2/catch.hpp>
#include <cmath>
#include <limits>
#include <numbers>

namespace target_detection_test {

using namespace reconnaissance;

namespace {

constexpr double kDegree = std::numbers::pi / 180;
const Camera kCamera{4 * kDegree, 3 * kDegree, 1920, 1080};
const Local kPlatform{0, 0, 1500};
const Local kTarget{1500, 1000, 0};
const CameraPose kPose{kPlatform, {0.2, 0.05, 1}, point_at(kPlatform, {0.2, 0.05, 1}, kTarget)};

double flat(double, double) { return 0; }

std::vector<Detection> frame(const Object& object, const Observer& observer, Random& random) {
  return detect(kPose, kCamera, std::span(&object, 1), observer, flat, random);
}

}  // namespace

TEST_CASE("The more line pairs across an object, the more probable an observer succeeds") {
  // Ratches and others, Static Performance Model, ECOM-7043, 1975: probability by the number of
  // line pairs against that for one half.
  const struct {
    double pairs;
    double probability;
  } table[]{{3, 1.0}, {2, 0.95}, {1.5, 0.80}, {1, 0.50}, {0.75, 0.30}, {0.5, 0.10}, {0.25, 0.02}};
  double worst = 0;
  for (const auto& [pairs, probability] : table) {
    for (const double half : {kDetectionPairs, kIdentificationPairs}) {
      const double pixels_across = 2 * pairs * half;
      worst = std::max(
          worst, std::abs(observer_probability(0.3 * pixels_across, 0.3, half) - probability));
    }
  }
  INFO("worst difference " << worst);
  CHECK(worst < 0.021);
  CHECK(observer_probability(0, 0.3, kDetectionPairs) == 0);
  CHECK(observer_probability(5, std::numeric_limits<double>::infinity(), kIdentificationPairs) ==
        0);
  CHECK(observer_probability(1e6, 0.001, kDetectionPairs) == 1);
}

TEST_CASE("An object is detected as often as its ground sample distance says") {
  Random random(51);
  const auto sample = ground_sample(kPose, kCamera, {}, flat);
  REQUIRE(sample);
  constexpr int kFrames = 4000;
  for (const double pixels : {1.5, 2.0, 3.0}) {
    int detected = 0;
    const Object object{kTarget, pixels * sample->distance_m()};
    for (int i = 0; i < kFrames; ++i) {
      detected += static_cast<int>(frame(object, {.false_alarms_per_km2 = 0}, random).size());
    }
    const double expected = observer_probability(pixels, 1, kDetectionPairs);
    CHECK(static_cast<double>(detected) / kFrames ==
          Approx(expected).margin(4 * std::sqrt(expected * (1 - expected) / kFrames)));
  }
}

TEST_CASE("What is hidden or outside of the frame is not detected") {
  Random random(52);
  const Observer keen{.false_alarms_per_km2 = 0};
  CHECK(frame({kTarget, 10}, keen, random).size() == 1);
  CHECK(frame({{1500, 1200, 0}, 10}, keen, random).empty());
  const auto ridge = [](double north_m, double east_m) {
    return std::abs(std::hypot(north_m, east_m) - 1500) < 60 ? 900.0 : 0.0;
  };
  const Object object{kTarget, 10};
  CHECK(detect(kPose, kCamera, std::span(&object, 1), keen, ridge, random).empty());
}

TEST_CASE("False alarms are as many as their rate says, and within the footprint") {
  Random random(53);
  const auto seen = footprint(kPose, kCamera, flat);
  REQUIRE(seen);
  const Observer nervous{.false_alarms_per_km2 = 30};
  const double mean = 30 * seen->area_m2() / 1e6;
  constexpr int kFrames = 3000;
  double number = 0;
  double squares = 0;
  double right = 0;
  for (int i = 0; i < kFrames; ++i) {
    const auto detections = detect(kPose, kCamera, {}, nervous, flat, random);
    number += static_cast<double>(detections.size()) / kFrames;
    squares += std::pow(static_cast<double>(detections.size()), 2) / kFrames;
    for (const Detection& alarm : detections) {
      const auto point = in_image(kPose, {4.4 * kDegree, 3.4 * kDegree, 1, 1},
                                  {alarm.position.mean[0], alarm.position.mean[1], 0});
      REQUIRE(point);
      right += point->right / (mean * kFrames);
    }
  }
  INFO("mean " << mean);
  CHECK(number == Approx(mean).margin(4 * std::sqrt(mean / kFrames)));
  // A Poisson number's variance is its mean.
  CHECK(squares - number * number == Approx(mean).epsilon(0.12));
  CHECK(right == Approx(0).margin(4 * 0.02 / std::sqrt(mean * kFrames)));
}

TEST_CASE("Positions scatter as a shaken line of sight scatters on the ground") {
  Random random(54);
  const double sigma = 1e-3;
  const auto middle = ground_sample(kPose, kCamera, {}, flat);
  REQUIRE(middle);
  Eigen::Matrix2d shaken = Eigen::Matrix2d::Zero();
  constexpr int kRuns = 4000;
  for (int run = 0; run < kRuns; ++run) {
    const auto hit = ground_at(kPose, {sigma * random.normal(), sigma * random.normal()}, flat);
    REQUIRE(hit);
    const Eigen::Vector2d error(hit->north_m - middle->place.north_m,
                                hit->east_m - middle->place.east_m);
    shaken += error * error.transpose() / kRuns;
  }
  const Eigen::Matrix2d stated = position_covariance_m2(kPlatform, *middle, sigma);
  CHECK((stated - shaken).norm() < 0.07 * shaken.norm());
  // And detections by what they state themselves.
  double sum = 0;
  for (int run = 0; run < kRuns; ++run) {
    const auto found = frame({kTarget, 100}, {.false_alarms_per_km2 = 0}, random);
    REQUIRE(found.size() == 1);
    sum += skein::fusion::nees(found[0].position, {kTarget.north_m, kTarget.east_m});
  }
  CHECK(sum / kRuns > skein::fusion::chi_square_quantile(0.001, 2 * kRuns) / kRuns);
  CHECK(sum / kRuns < skein::fusion::chi_square_quantile(0.999, 2 * kRuns) / kRuns);
}

TEST_CASE("The same seed gives the same detections") {
  const Object object{kTarget, 1};
  const Observer observer{.false_alarms_per_km2 = 20};
  const auto once = [&] {
    Random random(55);
    std::vector<double> numbers;
    for (int i = 0; i < 50; ++i) {
      for (const Detection& found : frame(object, observer, random)) {
        numbers.push_back(found.position.mean[0]);
      }
    }
    return numbers;
  };
  CHECK(once() == once());
  CHECK(once().size() > 10);
}

}  // namespace target_detection_test
