#include "navigation/threats/terrain_mask.hpp"

#include <algorithm>
#include <cmath>

#include "navigation/terrain/ground_clearance.hpp"
#include "navigation/terrain/plane_geometry.hpp"

namespace skein::navigation {
namespace {

constexpr double kEffectiveRadius_m = 6371008.8 * 4 / 3;

}  // namespace

bool TerrainMask::sees(const Position& antenna, const Position& point,
                       double exact_within_m) const {
  const double distance = distance_m(on_map(antenna), on_map(point));
  const double drop = earth_drop_m(distance);
  const auto ray = [&](double share) {
    Position at = between(antenna, point, share);
    at.altitude_m += earth_drop_m(share * distance) - share * drop;
    return at;
  };
  const bool near = distance < exact_within_m;
  const int pieces = static_cast<int>(distance / ceilings_.block_m()) + 1;
  // From the aircraft inwards: what hides it is mostly near it.
  Position outer = point;
  for (int piece = pieces - 1; piece >= 0; --piece) {
    const Position inner = ray(static_cast<double>(piece) / pieces);
    if (std::min(inner.altitude_m, outer.altitude_m) < ceilings_.above(inner, outer) &&
        hides(inner, outer, near)) {
      return false;
    }
    outer = inner;
  }
  return true;
}

/// Whether the ground reaches up to the piece of a ray; its inner end, the antenna maybe, is left
/// out where posts are sampled.
bool TerrainMask::hides(const Position& inner, const Position& outer, bool exactly) const {
  if (exactly) return ground_clearance(terrain_, inner, outer).lowest_m < 0;
  constexpr int kSamples = TerrainCeilings::kPosts;
  for (int i = 1; i <= kSamples; ++i) {
    const Position at = between(inner, outer, static_cast<double>(i) / kSamples);
    if (terrain_.height_m(at.north_m, at.east_m) > at.altitude_m) return true;
  }
  return false;
}

Position mast_top(const Terrain& terrain, const GroundPoint& foot, double height_m) {
  return {foot.north_m, foot.east_m, terrain.height_m(foot.north_m, foot.east_m) + height_m};
}

double earth_drop_m(double distance_m) {
  return distance_m * distance_m / (2 * kEffectiveRadius_m);
}

}  // namespace skein::navigation
