#include "sensing/image_quality.hpp"

#include <algorithm>
#include <cmath>

namespace reconnaissance {

double niirs(const GroundSample& sample, const Sharpness& sharpness) {
  constexpr double kInch_m = 0.0254;
  const double inches = std::sqrt(sample.across_columns_m * sample.across_rows_m) / kInch_m;
  const double edge = std::log10(sharpness.edge_response);
  const double rating = 9.57 - 3.32 * std::log10(inches) +
                        3.32 * (1 - std::exp(-1.9 / sharpness.signal_to_noise)) * edge -
                        2 * std::pow(edge, 4) - 1.8 / sharpness.signal_to_noise;
  return std::clamp(rating, 0.0, 9.0);
}

}  // namespace reconnaissance
