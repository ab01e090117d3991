#pragma once

#include "navigation/terrain/terrain.hpp"
#include "navigation/terrain/terrain_ceilings.hpp"
#include "navigator.idl.hpp"

namespace skein::navigation {

/// What the ground hides: rays are straight over an earth of 4/3 its radius (the usual allowance
/// for refraction). Const members may be called from any thread. The terrain must outlive it.
class TerrainMask {
 public:
  explicit TerrainMask(const Terrain& terrain) : terrain_(terrain), ceilings_(terrain) {}

  /// Whether nothing stands between an antenna and a point. Within `exact_within_m` of the antenna
  /// on the map the ray is followed exactly over the bilinear ground; beyond, post by post.
  bool sees(const AE_navigator::Position& antenna, const AE_navigator::Position& point,
            double exact_within_m) const;

 private:
  bool hides(const AE_navigator::Position& inner, const AE_navigator::Position& outer,
             bool exactly) const;

  const Terrain& terrain_;
  TerrainCeilings ceilings_;
};

/// The top of a mast of `height_m` above the ground at its foot: where an antenna is.
AE_navigator::Position mast_top(const Terrain& terrain, const AE_navigator::GroundPoint& foot,
                                double height_m);

/// How far a straight ray that leaves horizontally is above the curved earth after `distance_m`,
/// over an earth of 4/3 its radius.
double earth_drop_m(double distance_m);

}  // namespace skein::navigation
