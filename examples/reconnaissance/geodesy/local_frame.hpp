#pragma once

#include <GeographicLib/AzimuthalEquidistant.hpp>

namespace reconnaissance {

/// A place on WGS-84; the height is above the geoid.
struct Geodetic {
  double latitude_deg = 0;
  double longitude_deg = 0;
  double height_m = 0;
};

/// A place by its distances from the mission's origin; the height is above the geoid, too.
struct Local {
  double north_m = 0;
  double east_m = 0;
  double height_m = 0;
};

/// Local coordinates about an origin: distances and bearings from it are exact, others within
/// 3 parts in a million as far out as 28 km.
class LocalFrame {
 public:
  explicit LocalFrame(const Geodetic& origin) : origin_(origin) {}

  Local to_local(const Geodetic& place) const {
    Local local{0, 0, place.height_m};
    projection_.Forward(origin_.latitude_deg, origin_.longitude_deg, place.latitude_deg,
                        place.longitude_deg, local.east_m, local.north_m);
    return local;
  }

  Geodetic to_geodetic(const Local& local) const {
    Geodetic place{0, 0, local.height_m};
    projection_.Reverse(origin_.latitude_deg, origin_.longitude_deg, local.east_m, local.north_m,
                        place.latitude_deg, place.longitude_deg);
    return place;
  }

 private:
  Geodetic origin_;
  GeographicLib::AzimuthalEquidistant projection_;
};

}  // namespace reconnaissance
