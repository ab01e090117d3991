#include "navigation/routes/route_profiles.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include "navigation/routes/terrain_shading.hpp"
#include "navigation/terrain/plane_geometry.hpp"
#include "navigation/threats/radar_exposure.hpp"

namespace skein::navigation {
namespace {

constexpr double kTop = 26;   ///< Room for the label above a profile.
constexpr double kBar = 6;    ///< Height of the bar of exposure.
constexpr double kAxis = 20;  ///< Room for distances below it.
constexpr int kSamples = 360;

/// A route as a function of the distance flown over the map.
class Unrolled {
 public:
  explicit Unrolled(const std::vector<Position>& waypoints) : waypoints_(waypoints) {
    for (std::size_t i = 0; i < waypoints.size(); ++i) {
      flown_.push_back(
          i == 0 ? 0 : flown_.back() + distance_m(on_map(waypoints[i - 1]), on_map(waypoints[i])));
    }
  }
  double length_m() const { return flown_.back(); }

  Position at(double distance) const {
    const auto after = std::upper_bound(flown_.begin() + 1, flown_.end() - 1, distance);
    const auto i = static_cast<std::size_t>(after - flown_.begin());
    const double edge = flown_[i] - flown_[i - 1];
    return between(waypoints_[i - 1], waypoints_[i],
                   edge > 0 ? std::clamp((distance - flown_[i - 1]) / edge, 0.0, 1.0) : 0);
  }

 private:
  const std::vector<Position>& waypoints_;
  std::vector<double> flown_;
};

struct Scales {
  double left, width, longest_m;
  double lowest_m, highest_m;

  double x(double distance_m) const { return left + width * distance_m / longest_m; }
  double y(double altitude_m, double top) const {
    const double height = kProfileHeight - kTop - kBar - kAxis - 12;
    return top + kTop + height * (highest_m - altitude_m) / (highest_m - lowest_m);
  }
};

/// Distances flown, with a line through the profile at each.
void add_distances(Svg& svg, const Scales& scales, double top) {
  const double bottom = scales.y(scales.lowest_m, top);
  const double step = round_number(scales.longest_m / 6);
  for (double distance = 0; distance <= scales.longest_m; distance += step) {
    svg.add(R"svg(<path d="M{0:.1f} {1:.1f}V{2:.1f}" stroke="#c3cad1" stroke-width="0.8"/><text
x="{0:.1f}" y="{3:.1f}" class="tick" text-anchor="middle">{4:g} km</text>)svg",
            scales.x(distance), top + kTop - 4, bottom + kBar + 7, bottom + kBar + 18,
            distance / 1000);
  }
}

void add_profile(Svg& svg, const Terrain& terrain, const RadarExposure& exposure,
                 const Unrolled& route, std::string_view colour, const Scales& scales, double top) {
  const double bottom = scales.y(scales.lowest_m, top);
  std::string ground = fmt::format("M{:.1f} {:.1f}", scales.left, bottom);
  std::string flight;
  svg.add(R"svg(<g shape-rendering="crispEdges">)svg");
  for (int i = 0; i <= kSamples; ++i) {
    const double distance = route.length_m() * i / kSamples;
    const Position here = route.at(distance);
    const double x = scales.x(distance);
    ground += fmt::format("L{:.1f} {:.1f}", x,
                          scales.y(terrain.height_m(here.north_m, here.east_m), top));
    flight += fmt::format("{}{:.1f} {:.1f}", i == 0 ? 'M' : 'L', x, scales.y(here.altitude_m, top));
    if (const double strength = tint(exposure.rate(here)); strength > 0 && i < kSamples) {
      svg.add(R"svg(<rect x="{:.1f}" y="{:.1f}" width="{:.2f}" height="{}" fill="#c70d38"
fill-opacity="{:.2f}"/>)svg",
              x, bottom + 3, scales.x(route.length_m() / kSamples) - scales.left, kBar,
              0.25 + 0.75 * strength);
    }
  }
  svg.add("</g>");
  ground += fmt::format("L{:.1f} {:.1f}Z", scales.x(route.length_m()), bottom);
  svg.add(R"svg(<path d="{}" fill="#b9a98f" stroke="#8a7a60" stroke-width="0.8"/>)svg", ground);
  svg.add(R"svg(<path d="{}" fill="none" stroke="{}" stroke-width="2.2"
stroke-linejoin="round"/>)svg",
          flight, colour);
}

}  // namespace

bool drawable(const AE_navigator::Route& route) {
  return route.waypoints.size() > 1 &&
         std::all_of(route.waypoints.begin(), route.waypoints.end(), [](const Position& p) {
           return std::isfinite(p.north_m) && std::isfinite(p.east_m) &&
                  std::isfinite(p.altitude_m);
         });
}

void add_profiles(Svg& svg, const Terrain& terrain, const AE_navigator::Problem& problem,
                  std::span<const PicturedRoute> routes, double left, double top, double width) {
  const RadarExposure exposure(terrain, problem.radar_sites);
  Scales scales{left, width, 1, terrain.lowest_m(), terrain.lowest_m() + 100.0};
  for (const PicturedRoute& pictured : routes) {
    if (!drawable(pictured.route)) continue;
    scales.longest_m = std::max(scales.longest_m, Unrolled(pictured.route.waypoints).length_m());
    for (const Position& p : pictured.route.waypoints) {
      scales.highest_m = std::max(scales.highest_m, p.altitude_m);
    }
  }
  scales.highest_m += 0.05 * (scales.highest_m - scales.lowest_m);
  for (std::size_t i = 0; i < routes.size(); ++i) {
    if (!drawable(routes[i].route)) continue;
    const double bottom = scales.y(scales.lowest_m, top);
    svg.add(R"svg(<rect x="{:.1f}" y="{:.1f}" width="{:.1f}" height="{:.1f}" fill="#eef1f4"/>)svg",
            left, top + kTop - 4, width, bottom - top - kTop + 4);
    svg.add(R"svg(<text x="{:.1f}" y="{:.1f}" class="small"><tspan fill="{}"
font-weight="600">{}</tspan></text>)svg",
            left, top + kTop - 11, route_colour(i), escaped(routes[i].label));
    add_distances(svg, scales, top);
    add_profile(svg, terrain, exposure, Unrolled(routes[i].route.waypoints), route_colour(i),
                scales, top);
    for (const double altitude : {scales.lowest_m, scales.highest_m}) {
      svg.add(R"svg(<text x="{:.1f}" y="{:.1f}" class="tick" text-anchor="end">{:.0f} m</text>)svg",
              left - 6, scales.y(altitude, top) + 4, altitude);
    }
    top += kProfileHeight;
  }
}

}  // namespace skein::navigation
