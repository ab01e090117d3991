#pragma once

#include "sensing/camera.hpp"

namespace reconnaissance {

/// The mission's requirement: an element of interest is collected if its pixels are so many metres
/// apart or less, in both directions.
inline constexpr double kCollected_m = 0.3;

inline bool is_collected(const GroundSample& sample) { return sample.distance_m() <= kCollected_m; }

/// What of an image beside its scale decides how well it can be interpreted.
struct Sharpness {
  double edge_response = 0.35;  ///< Relative edge response (RER): of a step of one pixel, 0 to 1.
  double signal_to_noise = 50;
};

/// The image's rating on the National Image Interpretability Rating Scale (0 to 9) by the General
/// Image Quality Equation, version 5: 9.57 − 3.32 lg GSD + 3.32 (1 − exp(−1.9 / SNR)) lg RER −
/// 2 lg⁴ RER − 1.8 / SNR, with the geometric mean of both ground sample distances in inches (NGA,
/// "General Image Quality Equation, GIQE version 5.0", 2015).
double niirs(const GroundSample& sample, const Sharpness& sharpness = {});

}  // namespace reconnaissance
