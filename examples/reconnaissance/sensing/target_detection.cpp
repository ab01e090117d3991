#include "sensing/target_detection.hpp"

#include <algorithm>
#include <cmath>

namespace reconnaissance {
namespace {

using Eigen::Matrix2d, Eigen::Vector2d;

/// After Knuth, The Art of Computer Programming 2, 3.4.1: for means of some ten at most.
int draw_poisson(double mean, Random& random) {
  int number = -1;
  for (double product = 1; product > std::exp(-mean); product *= random.uniform()) ++number;
  return number;
}

Detection measure(const CameraPose& pose, const GroundSample& sample, const Observer& observer,
                  Random& random) {
  const Matrix2d covariance =
      position_covariance_m2(pose.place, sample, observer.pointing_sigma_rad);
  const Matrix2d root = covariance.llt().matrixL();
  const double first = random.normal();
  const Vector2d error = root * Vector2d(first, random.normal());
  return {{{sample.place.north_m + error.x(), sample.place.east_m + error.y()},
           {covariance(0, 0), covariance(0, 1), covariance(0, 1), covariance(1, 1)}},
          sample.slant_range_m,
          sample.distance_m()};
}

/// Uniform over the ground that the frame shows and that is in the open.
std::optional<GroundSample> draw_place(const CameraPose& pose, const Camera& camera,
                                       const Footprint& seen, const GroundHeight& ground,
                                       Random& random) {
  const auto [south, north] =
      std::minmax_element(seen.corners.begin(), seen.corners.end(),
                          [](const Local& a, const Local& b) { return a.north_m < b.north_m; });
  const auto [west, east] =
      std::minmax_element(seen.corners.begin(), seen.corners.end(),
                          [](const Local& a, const Local& b) { return a.east_m < b.east_m; });
  for (int attempt = 0; attempt < 100; ++attempt) {
    Local place;
    place.north_m = std::lerp(south->north_m, north->north_m, random.uniform());
    place.east_m = std::lerp(west->east_m, east->east_m, random.uniform());
    place.height_m = ground(place.north_m, place.east_m);
    if (const auto sample = ground_sample_of(pose, camera, place, ground)) return sample;
  }
  return std::nullopt;
}

}  // namespace

double observer_probability(double least_dimension_m, double sample_distance_m,
                            double line_pairs_for_half) {
  const double ratio = least_dimension_m / (2 * sample_distance_m) / line_pairs_for_half;
  const double power = std::pow(ratio, 2.7 + 0.7 * ratio);
  return std::isinf(power) ? 1 : power / (1 + power);
}

Matrix2d position_covariance_m2(const Local& camera, const GroundSample& sample,
                                double pointing_sigma_rad) {
  const Vector2d way(sample.place.north_m - camera.north_m, sample.place.east_m - camera.east_m);
  const Vector2d along = way.norm() > 0 ? Vector2d(way.normalized()) : Vector2d::UnitX();
  const double across_m = sample.slant_range_m * pointing_sigma_rad;
  const double along_m = across_m / std::sin(sample.grazing_rad);
  const double pixel_m2 = sample.distance_m() * sample.distance_m() / 12;
  return (across_m * across_m + pixel_m2) * Matrix2d::Identity() +
         (along_m * along_m - across_m * across_m) * along * along.transpose();
}

std::vector<Detection> detect(const CameraPose& pose, const Camera& camera,
                              std::span<const Object> objects, const Observer& observer,
                              const GroundHeight& ground, Random& random) {
  std::vector<Detection> detections;
  for (const Object& object : objects) {
    const auto sample = ground_sample_of(pose, camera, object.place, ground);
    if (!sample) continue;
    const double probability =
        observer_probability(object.least_dimension_m, sample->distance_m(), kDetectionPairs);
    if (random.happens(probability)) {
      detections.push_back(measure(pose, *sample, observer, random));
    }
  }
  const auto seen = footprint(pose, camera, ground);
  if (!seen) return detections;
  const double mean = observer.false_alarms_per_km2 * seen->area_m2() / 1e6;
  for (int left = draw_poisson(mean, random); left > 0; --left) {
    if (const auto sample = draw_place(pose, camera, *seen, ground, random)) {
      detections.push_back(measure(pose, *sample, observer, random));
    }
  }
  return detections;
}

}  // namespace reconnaissance
