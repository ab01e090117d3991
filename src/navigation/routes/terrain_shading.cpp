#include "navigation/routes/terrain_shading.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "navigation/threats/risk_map.hpp"

namespace skein::navigation {
namespace {

/// How bright a slope is with the sun in the north-west, 45 degrees up; level ground is 0.7.
double brightness(const Terrain& terrain, double north_m, double east_m, double relief) {
  const double step_n = terrain.north_spacing_m();
  const double step_e = terrain.east_spacing_m();
  const double to_north =
      relief *
      (terrain.height_m(north_m + step_n, east_m) - terrain.height_m(north_m - step_n, east_m)) /
      (2 * step_n);
  const double to_east =
      relief *
      (terrain.height_m(north_m, east_m + step_e) - terrain.height_m(north_m, east_m - step_e)) /
      (2 * step_e);
  const double towards_sun = (-to_north + to_east) * 0.5 + std::sqrt(0.5);
  return std::max(0.0, towards_sun / std::sqrt(1 + to_north * to_north + to_east * to_east));
}

}  // namespace

Colour height_colour(double share) {
  constexpr std::array<Colour, 6> kScale{{{0.56, 0.68, 0.53},
                                          {0.73, 0.78, 0.58},
                                          {0.89, 0.85, 0.68},
                                          {0.82, 0.71, 0.55},
                                          {0.72, 0.62, 0.54},
                                          {0.95, 0.95, 0.95}}};
  const double place = std::clamp(share, 0.0, 1.0) * (kScale.size() - 1);
  const auto below = std::min(static_cast<std::size_t>(place), kScale.size() - 2);
  return mix(kScale[below], kScale[below + 1], place - static_cast<double>(below));
}

double tint(double exposure_rate) {
  constexpr double kLeast = 0.05;
  if (exposure_rate <= kLeast) return 0;
  return std::min(1.0, std::log(exposure_rate / kLeast) / std::log(60 / kLeast));
}

Image shade(const Terrain& terrain, const AE_navigator::Problem& problem, int width, int height) {
  const double range = std::max(1.0f, terrain.highest_m() - terrain.lowest_m());
  // Flat land gets its hills exaggerated, mountains stay what they are.
  const double relief = std::clamp(2000 / range, 1.5, 8.0);
  const PlanningGrid grid(terrain, 0);
  std::vector<float> altitudes;
  for (int node = 0; node < grid.size(); ++node) {
    const GroundPoint point = grid.point(node);
    altitudes.push_back(static_cast<float>(terrain.height_m(point.north_m, point.east_m) +
                                           problem.minimum_height_above_ground_m));
  }
  RiskMap risk(terrain, grid, altitudes);
  risk.add(problem.radar_sites, 1);

  Image image(width, height);
  for (int y = 0; y < height; ++y) {
    const double north = terrain.north_extent_m() * (1 - (y + 0.5) / height);
    for (int x = 0; x < width; ++x) {
      const double east = terrain.east_extent_m() * (x + 0.5) / width;
      const double share = (terrain.height_m(north, east) - terrain.lowest_m()) / range;
      const double light = 0.45 + 0.8 * brightness(terrain, north, east, relief);
      const Colour ground = height_colour(share);
      const Colour lit{ground.red * light, ground.green * light, ground.blue * light};
      image.set(x, y, mix(lit, kExposureColour, 0.6 * tint(risk.rate(GroundPoint{north, east}))));
    }
  }
  return image;
}

}  // namespace skein::navigation
