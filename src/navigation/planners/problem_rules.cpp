#include "navigation/planners/problem_rules.hpp"

#include <fmt/core.h>

#include <cmath>
#include <initializer_list>
#include <numbers>

#include "navigation/threats/keep_out.hpp"

namespace skein::navigation {
namespace {

constexpr std::size_t kMaxZones = 1000;
constexpr std::size_t kMaxCorners = 1000;
constexpr std::size_t kMaxSites = 1000;
/// Of weights and of what sites do to whom they see. All sites together then stay within what a
/// float holds, in which the maps of risks count: 1e12 * 1e12 * 1000, times 256 near a radar.
constexpr double kLargestWeight = 1e12;
constexpr double kDegree = std::numbers::pi / 180;

template <class... Arguments>
void require(bool holds, fmt::format_string<Arguments...> text, Arguments&&... arguments) {
  if (!holds) {
    throw AE_navigator::InvalidProblem(fmt::format(text, std::forward<Arguments>(arguments)...));
  }
}

bool finite(std::initializer_list<double> numbers) {
  for (const double number : numbers) {
    if (!std::isfinite(number)) return false;
  }
  return true;
}

void require_valid_limits(const AE_navigator::Problem& problem) {
  const auto& limits = problem.limits;
  require(std::isfinite(limits.speed_m_s) && limits.speed_m_s > 0,
          "the speed is {} m/s; it must be greater than 0", limits.speed_m_s);
  require(limits.maximum_climb_angle_deg > 0 && limits.maximum_climb_angle_deg < 90,
          "the maximum climb angle is {} degrees; it must lie between 0 and 90",
          limits.maximum_climb_angle_deg);
  require(
      limits.maximum_bank_angle_deg >= 0 && limits.maximum_bank_angle_deg < 90,
      "the maximum bank angle is {} degrees; it must be 0 (no limit on turns) or more, and less "
      "than 90",
      limits.maximum_bank_angle_deg);
  require(std::isfinite(limits.maximum_altitude_m), "the maximum altitude is not a finite number");
  require(std::isfinite(problem.minimum_height_above_ground_m) &&
              problem.minimum_height_above_ground_m >= 0,
          "the minimum height above ground is {} m; it must be 0 or more",
          problem.minimum_height_above_ground_m);
  require(problem.exposure_weight >= 0 && problem.exposure_weight <= kLargestWeight,
          "the exposure weight is {:g}; it must lie between 0 and {:g}", problem.exposure_weight,
          kLargestWeight);
  require(problem.kill_weight_m >= 0 && problem.kill_weight_m <= kLargestWeight,
          "the weight of an expected kill is {:g} m; it must lie between 0 and {:g}",
          problem.kill_weight_m, kLargestWeight);
  require(std::isfinite(problem.exposure_cap_m) && problem.exposure_cap_m >= 0,
          "the exposure cap is {} m; it must be 0 (no cap) or more", problem.exposure_cap_m);
}

void require_valid_zone(const AE_navigator::NoFlyZone& zone) {
  require(!zone.outline.empty() && zone.outline.size() <= kMaxCorners,
          "no-fly zone '{}' has {} corners; it must have 1 to {}", zone.name, zone.outline.size(),
          kMaxCorners);
  for (const auto& corner : zone.outline) {
    require(finite({corner.north_m, corner.east_m}),
            "no-fly zone '{}' has a corner that is not a finite number", zone.name);
  }
  require(finite({zone.margin_m, zone.floor_m, zone.ceiling_m}),
          "the margin, floor or ceiling of no-fly zone '{}' is not a finite number", zone.name);
  require(zone.margin_m >= 0, "the margin of no-fly zone '{}' is {} m; it must be 0 or more",
          zone.name, zone.margin_m);
  require(zone.outline.size() > 2 || zone.margin_m > 0,
          "no-fly zone '{}' has fewer than 3 corners and no margin, so there is nothing inside",
          zone.name);
  require(zone.floor_m < zone.ceiling_m,
          "no-fly zone '{}' has its floor, {} m, above its ceiling, "
          "{} m",
          zone.name, zone.floor_m, zone.ceiling_m);
}

/// `rate` is what the site does to whom it sees; `rate_name` is what people call that.
template <class Site>
void require_valid_site(const char* kind, const Site& site, double rate, const char* rate_name,
                        const Terrain& terrain) {
  require(finite({site.site.north_m, site.site.east_m, site.mast_height_m, site.range_m, rate}),
          "{} site '{}' has a number that is not finite", kind, site.name);
  require(terrain.contains(site.site.north_m, site.site.east_m),
          "{} site '{}' stands off the terrain '{}'", kind, site.name, terrain.name());
  require(site.mast_height_m > 0 && site.range_m > 0 && rate >= 0,
          "{} site '{}' needs a mast and a range greater than 0 and a {} of 0 or more", kind,
          site.name, rate_name);
  require(rate <= kLargestWeight, "the {} of {} site '{}' is {:g}; it must be {:g} or less",
          rate_name, kind, site.name, rate, kLargestWeight);
}

void require_valid_end(const char* which, const AE_navigator::Position& end,
                       const AE_navigator::Problem& problem, const Terrain& terrain) {
  require(finite({end.north_m, end.east_m, end.altitude_m}),
          "the {} has a coordinate that is not a finite number", which);
  require(
      terrain.contains(end.north_m, end.east_m),
      "the {}, {:.0f} m north and {:.0f} m east, lies off the terrain '{}', which is {:.0f} m by "
      "{:.0f} m",
      which, end.north_m, end.east_m, terrain.name(), terrain.north_extent_m(),
      terrain.east_extent_m());
  const double height = end.altitude_m - terrain.height_m(end.north_m, end.east_m);
  require(height >= problem.minimum_height_above_ground_m,
          "the {} is {:.1f} m above the ground; the minimum is {:.1f} m", which, height,
          problem.minimum_height_above_ground_m);
  require(end.altitude_m <= problem.limits.maximum_altitude_m,
          "the {} is at {:.0f} m; the maximum altitude is {:.0f} m", which, end.altitude_m,
          problem.limits.maximum_altitude_m);
  for (const auto& zone : problem.no_fly_zones) {
    require(!KeepOut(zone, 0).contains(end), "the {} lies inside the no-fly zone '{}'", which,
            zone.name);
  }
}

}  // namespace

void require_valid(const AE_navigator::Problem& problem, const Terrain& terrain) {
  require_valid_limits(problem);
  require(problem.no_fly_zones.size() <= kMaxZones, "there are {} no-fly zones; {} are the most",
          problem.no_fly_zones.size(), kMaxZones);
  require(problem.radar_sites.size() <= kMaxSites, "there are {} radar sites; {} are the most",
          problem.radar_sites.size(), kMaxSites);
  for (const auto& zone : problem.no_fly_zones) require_valid_zone(zone);
  for (const auto& site : problem.radar_sites)
    require_valid_site("radar", site, site.strength, "strength", terrain);
  require(problem.missile_sites.size() <= kMaxSites, "there are {} missile sites; {} are the most",
          problem.missile_sites.size(), kMaxSites);
  for (const auto& site : problem.missile_sites)
    require_valid_site("missile", site, site.kills_per_second, "rate", terrain);
  require_valid_end("start", problem.start, problem, terrain);
  require_valid_end("goal", problem.goal, problem, terrain);
}

double turn_radius_m(const AE_flightControllerI::FlightLimits& limits) {
  if (limits.maximum_bank_angle_deg == 0) return 0;
  return limits.speed_m_s * limits.speed_m_s /
         (9.80665 * std::tan(limits.maximum_bank_angle_deg * kDegree));
}

double climb_slope(const AE_flightControllerI::FlightLimits& limits) {
  return std::tan(limits.maximum_climb_angle_deg * kDegree);
}

}  // namespace skein::navigation
