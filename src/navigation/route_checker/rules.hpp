#pragma once

#include "navigation/route_checker/height_grid.hpp"
#include "navigator.idl.hpp"

// The single judgements that check_route puts together.
namespace skein::navigation::route_checker {

/// Bilinear between the posts.
double ground_height(const HeightGrid& ground, double north_m, double east_m);

/// The smallest height above ground anywhere on the edge.
double lowest_height(const HeightGrid& ground, const AE_navigator::Position& a,
                     const AE_navigator::Position& b);

/// Where the edge enters the zone, as a share of its length; negative if it does not. An edge that
/// only touches the zone does not enter it.
double entry_into(const AE_navigator::NoFlyZone& zone, const AE_navigator::Position& a,
                  const AE_navigator::Position& b);

/// Exposure to one site along the edge.
double exposure(const HeightGrid& ground, const AE_navigator::RadarSite& site,
                const AE_navigator::Position& a, const AE_navigator::Position& b);

/// Metres of the edge that are within the site's range and in its sight.
double metres_in_danger(const HeightGrid& ground, const AE_navigator::MissileSite& site,
                        const AE_navigator::Position& a, const AE_navigator::Position& b);

}  // namespace skein::navigation::route_checker
