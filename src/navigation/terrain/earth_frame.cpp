#include "navigation/terrain/earth_frame.hpp"

#include <GeographicLib/AzimuthalEquidistant.hpp>

namespace skein::navigation {

AE_navigator::GroundPoint EarthFrame::to_ground(const EarthPlace& place) const {
  AE_navigator::GroundPoint point;
  GeographicLib::AzimuthalEquidistant().Forward(middle_.latitude_deg, middle_.longitude_deg,
                                                place.latitude_deg, place.longitude_deg,
                                                point.east_m, point.north_m);
  point.north_m += middle_point_.north_m;
  point.east_m += middle_point_.east_m;
  return point;
}

EarthPlace EarthFrame::to_earth(const AE_navigator::GroundPoint& point) const {
  EarthPlace place;
  GeographicLib::AzimuthalEquidistant().Reverse(
      middle_.latitude_deg, middle_.longitude_deg, point.east_m - middle_point_.east_m,
      point.north_m - middle_point_.north_m, place.latitude_deg, place.longitude_deg);
  return place;
}

}  // namespace skein::navigation
