#pragma once

#include <span>
#include <vector>

#include "random.hpp"
#include "sensing/camera.hpp"
#include "skein/fusion.hpp"

namespace reconnaissance {

/// What an observer makes of an object, by the line pairs that he needs across it to do so in one
/// case of two (Johnson, "Analysis of image forming systems", Image Intensifier Symposium, 1958).
inline constexpr double kDetectionPairs = 1.0;
inline constexpr double kIdentificationPairs = 6.4;

/// How probable an observer succeeds with an object of that least dimension in an image of that
/// ground sample distance. A line pair is two pixels. By the target transfer function
/// (N / N50)^E / (1 + (N / N50)^E) with E = 2.7 + 0.7 N / N50 (Holst, "Electro-Optical Imaging
/// System Performance", 2000), which fits the table of Ratches and others, "Night Vision Laboratory
/// Static Performance Model for Thermal Viewing Systems", ECOM-7043, 1975, to 0.021.
double observer_probability(double least_dimension_m, double sample_distance_m,
                            double line_pairs_for_half);

/// An object on the ground that can be seen.
struct Object {
  Local place;
  double least_dimension_m;
};

/// What is found in an image: an object, or something that looks like one.
struct Detection {
  skein::fusion::Estimate position;  ///< North and east.
  double slant_range_m;
  double sample_distance_m;
};

struct Observer {
  double false_alarms_per_km2 = 0.05;  ///< Of each frame.
  double pointing_sigma_rad = 0.5e-3;  ///< Of each of the two angles of the line of sight.
};

/// The covariance of a place that is seen in an image: errors of pointing across and along the line
/// of sight, those longer by 1 / sin(grazing), and a pixel's uniform error of distance / √12.
Eigen::Matrix2d position_covariance_m2(const Local& camera, const GroundSample& sample,
                                       double pointing_sigma_rad);

/// What is detected in one frame. Objects outside of the frame or hidden by the ground are not;
/// others by observer_probability() of their own ground sample distance. False alarms are a Poisson
/// number, uniform over the footprint; none if the frame shows sky. In the order of `objects`,
/// false alarms last.
std::vector<Detection> detect(const CameraPose& pose, const Camera& camera,
                              std::span<const Object> objects, const Observer& observer,
                              const GroundHeight& ground, Random& random);

}  // namespace reconnaissance
