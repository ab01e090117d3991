#include "navigation/routes/route_picture.hpp"

#include <algorithm>
#include <cmath>

#include "core/whole_file.hpp"
#include "navigation/routes/route_lines.hpp"
#include "navigation/routes/route_profiles.hpp"
#include "navigation/routes/terrain_shading.hpp"
#include "navigation/terrain/plane_geometry.hpp"

namespace skein::navigation {
namespace {

constexpr double kWidth = 1240;
constexpr double kMapLeft = 62;
constexpr double kMapTop = 78;
constexpr double kMapSide = 820;
constexpr double kLegendLeft = kMapLeft + kMapSide + 34;
constexpr int kImageSide = 620;  ///< Points of the shaded map along its longer side.

/// Metres to units of the picture.
class MapScale {
 public:
  explicit MapScale(const Terrain& terrain)
      : units_per_m_(kMapSide / std::max(terrain.north_extent_m(), terrain.east_extent_m())),
        width_(terrain.east_extent_m() * units_per_m_),
        height_(terrain.north_extent_m() * units_per_m_) {}
  double width() const { return width_; }
  double height() const { return height_; }
  double x(double east_m) const { return kMapLeft + east_m * units_per_m_; }
  double y(double north_m) const { return kMapTop + height_ - north_m * units_per_m_; }
  double units(double metres) const { return metres * units_per_m_; }

 private:
  double units_per_m_;
  double width_;
  double height_;
};

void add_head(Svg& svg, const std::string& title, const Terrain& terrain, double height) {
  svg.add(R"svg(<svg xmlns="http://www.w3.org/2000/svg"
xmlns:xlink="http://www.w3.org/1999/xlink" viewBox="0 0 {} {:.0f}" width="{}" height="{:.0f}">)svg",
          kWidth, height, kWidth, height);
  svg.add("<title>{}</title>", escaped(title));
  svg.add(R"svg(<style>text{{font-family:"DejaVu Sans",Helvetica,Arial,sans-serif;fill:#1f2933}}
.title{{font-size:23px;font-weight:600}}.sub{{font-size:13px;fill:#5b6770}}
.small{{font-size:13px}}.tick{{font-size:11px;fill:#5b6770}}
.name{{font-size:12.5px;font-weight:600;paint-order:stroke;stroke:#fff;stroke-width:3.2px;
stroke-linejoin:round}}
</style>)svg");
  svg.add(R"svg(<defs><pattern id="hatch" width="9" height="9" patternUnits="userSpaceOnUse"
patternTransform="rotate(45)"><rect width="3" height="9" fill="#a01020"/></pattern></defs>)svg");
  svg.add(R"svg(<rect width="100%" height="100%" fill="#fcfbf8"/>)svg");
  svg.add(R"svg(<text x="{}" y="38" class="title">{}</text>)svg", kMapLeft, escaped(title));
  svg.add(R"svg(<text x="{}" y="60"
class="sub">terrain {}, {:.0f} km by {:.0f} km, {:.0f} m to {:.0f} m</text>)svg",
          kMapLeft, escaped(terrain.name()), terrain.north_extent_m() / 1000,
          terrain.east_extent_m() / 1000, terrain.lowest_m(), terrain.highest_m());
}

void add_ground(Svg& svg, const Terrain& terrain, const AE_navigator::Problem& problem,
                const MapScale& map) {
  const double per_unit = kImageSide / kMapSide;
  const Image image = shade(terrain, problem, std::max(1, static_cast<int>(map.width() * per_unit)),
                            std::max(1, static_cast<int>(map.height() * per_unit)));
  svg.add(R"svg(<clipPath id="map"><rect x="{}" y="{}" width="{:.1f}" height="{:.1f}"/>
</clipPath>)svg",
          kMapLeft, kMapTop, map.width(), map.height());
  svg.add(R"svg(<image x="{}" y="{}" width="{:.1f}" height="{:.1f}" preserveAspectRatio="none"
xlink:href="data:image/png;base64,{}"/>)svg",
          kMapLeft, kMapTop, map.width(), map.height(), image.png_base64());
}

void add_frame(Svg& svg, const Terrain& terrain, const MapScale& map) {
  svg.add(R"svg(<rect x="{}" y="{}" width="{:.1f}" height="{:.1f}" fill="none" stroke="#1f2933"
stroke-width="1.2"/>)svg",
          kMapLeft, kMapTop, map.width(), map.height());
  const double step = round_number(std::max(terrain.north_extent_m(), terrain.east_extent_m()) / 4);
  for (double metres = 0; metres <= terrain.east_extent_m(); metres += step) {
    svg.add(R"svg(<path d="M{0:.1f} {1:.1f}v6" stroke="#1f2933"/><text x="{0:.1f}" y="{2:.1f}"
class="tick" text-anchor="middle">{3:g} km</text>)svg",
            map.x(metres), kMapTop + map.height(), kMapTop + map.height() + 19, metres / 1000);
  }
  for (double metres = 0; metres <= terrain.north_extent_m(); metres += step) {
    svg.add(R"svg(<path d="M{0} {1:.1f}h-6" stroke="#1f2933"/><text x="{2}" y="{3:.1f}"
class="tick" text-anchor="end">{4:g} km</text>)svg",
            kMapLeft, map.y(metres), kMapLeft - 9, map.y(metres) + 4, metres / 1000);
  }
}

GroundPoint middle(const AE_navigator::NoFlyZone& zone) {
  GroundPoint sum{0, 0};
  for (const auto& corner : zone.outline) {
    sum.north_m += corner.north_m;
    sum.east_m += corner.east_m;
  }
  const auto count = static_cast<double>(zone.outline.size());
  return {sum.north_m / count, sum.east_m / count};
}

void add_zone(Svg& svg, const AE_navigator::NoFlyZone& zone, const MapScale& map) {
  std::string outline;
  for (const auto& corner : zone.outline) {
    outline += fmt::format("{}{:.1f} {:.1f}", outline.empty() ? 'M' : 'L', map.x(corner.east_m),
                           map.y(corner.north_m));
  }
  outline += 'Z';
  // The margin is a stroke with round corners: a wide one in the border's colour, then what is
  // inside.
  const double margin = 2 * map.units(zone.margin_m);
  const auto layer = [&](std::string_view fill, double width) {
    svg.add(R"svg(<path d="{0}" fill="{1}" stroke="{1}" stroke-width="{2:.1f}"
stroke-linejoin="round" stroke-linecap="round"/>)svg",
            outline, fill, width);
  };
  svg.add(R"svg(<g opacity="0.6">)svg");
  layer("#8f0d1c", margin + 2);
  layer("#f3c6c6", std::max(0.0, margin - 2));
  layer("url(#hatch)", std::max(0.0, margin - 2));
  svg.add("</g>");
}

struct Symbol {
  const char* outline;
  const char* colour;
  const char* dashes;  ///< Of the ring of its range.
};

constexpr Symbol kRadar{"M-7 8L0 -3L7 8ZM-5 -10A8 8 0 0 1 5 -10M-2.6 -6.4A4 4 0 0 1 2.6 -6.4",
                        "#7a0b23", "7 5"};
constexpr Symbol kMissiles{"M0 -11L4 -4V5L7 9H-7L-4 5V-4Z", "#3b1f8f", "2 4"};

void add_site(Svg& svg, const Symbol& symbol, const GroundPoint& site, double range_m,
              const MapScale& map) {
  const double x = map.x(site.east_m);
  const double y = map.y(site.north_m);
  svg.add(R"svg(<circle cx="{0:.1f}" cy="{1:.1f}" r="{2:.1f}" fill="none" stroke="#fff"
stroke-opacity="0.7" stroke-width="3"/><circle cx="{0:.1f}" cy="{1:.1f}" r="{2:.1f}"
fill="none" stroke="{3}" stroke-width="1.4" stroke-dasharray="{4}"/>)svg",
          x, y, map.units(range_m), symbol.colour, symbol.dashes);
  svg.add(R"svg(<g transform="translate({0:.1f} {1:.1f})" fill="none" stroke="#fff"
stroke-width="4"><path d="{2}"/><path d="{2}" stroke="{3}" stroke-width="1.8"/></g>)svg",
          x, y, symbol.outline, symbol.colour);
}

void add_site_name(Svg& svg, const std::string& name, const GroundPoint& site,
                   const MapScale& map) {
  svg.add(R"svg(<text x="{:.1f}" y="{:.1f}" class="name">{}</text>)svg", map.x(site.east_m) + 12,
          map.y(site.north_m) + 6, escaped(name));
}

/// Above all else on the map, so that no route hides them.
void add_names(Svg& svg, const AE_navigator::Problem& problem, const MapScale& map) {
  for (const auto& zone : problem.no_fly_zones) {
    const GroundPoint at = middle(zone);
    svg.add(R"svg(<text x="{:.1f}" y="{:.1f}" class="name" text-anchor="middle">{}</text>)svg",
            map.x(at.east_m), map.y(at.north_m) + 4, escaped(zone.name));
  }
  for (const auto& radar : problem.radar_sites) add_site_name(svg, radar.name, radar.site, map);
  for (const auto& missiles : problem.missile_sites)
    add_site_name(svg, missiles.name, missiles.site, map);
}

void add_route(Svg& svg, std::string_view path, std::string_view colour, double width) {
  svg.add(R"svg(<path d="{}" fill="none" stroke="{}" stroke-width="{}"
stroke-linejoin="round"/>)svg",
          path, colour, width);
}

/// The first one on top where they cross.
void add_routes(Svg& svg, std::span<const PicturedRoute> routes, const MapScale& map) {
  std::vector<std::vector<PicturePoint>> lines(routes.size());
  for (std::size_t i = 0; i < routes.size(); ++i) {
    if (!drawable(routes[i].route)) continue;
    for (const Position& p : routes[i].route.waypoints)
      lines[i].push_back({map.x(p.east_m), map.y(p.north_m)});
  }
  const std::vector<std::string> paths = lines_side_by_side(lines);
  for (const std::string& path : paths) {
    if (!path.empty()) add_route(svg, path, "#fff", 6);
  }
  for (std::size_t i = paths.size(); i-- > 0;) {
    if (!paths[i].empty()) add_route(svg, paths[i], route_colour(i), 3);
  }
}

void add_end(Svg& svg, const char* name, const Position& end, const char* fill,
             const MapScale& map) {
  const double x = map.x(end.east_m);
  const double y = map.y(end.north_m);
  svg.add(R"svg(<circle cx="{0:.1f}" cy="{1:.1f}" r="7.5" fill="{2}" stroke="#fff"
stroke-width="2.5"/><text x="{0:.1f}" y="{3:.1f}" class="name" text-anchor="middle"
font-size="14">{4}</text>)svg",
          x, y, fill, y - 14, name);
}

void add_scale_and_north(Svg& svg, const Terrain& terrain, const MapScale& map) {
  const double metres = round_number(terrain.east_extent_m() / 4);
  const double left = kMapLeft + 18;
  const double y = kMapTop + map.height() - 22;
  svg.add(R"svg(<rect x="{:.1f}" y="{:.1f}" width="{:.1f}" height="32" rx="4" fill="#fff"
fill-opacity="0.8"/>)svg",
          left - 9, y - 20, map.units(metres) + 18);
  svg.add(R"svg(<path d="M{0:.1f} {1:.1f}v5h{2:.1f}v-5" fill="none" stroke="#1f2933"
stroke-width="2"/><text x="{3:.1f}" y="{1:.1f}" class="small"
text-anchor="middle">{4:g} km</text>)svg",
          left, y, map.units(metres), left + map.units(metres) / 2, metres / 1000);
  svg.add(R"svg(<g transform="translate({:.1f} {:.1f})"><circle r="21" fill="#fff"
fill-opacity="0.8"/><path d="M0 -16L6 7L0 3Z" fill="#1f2933"/><path d="M0 -16L-6 7L0 3Z"
fill="#fff" stroke="#1f2933" stroke-width="1"/><text y="19" class="tick" text-anchor="middle"
font-weight="600">N</text></g>)svg",
          kMapLeft + map.width() - 32, kMapTop + 32);
}

double add_route_legend(Svg& svg, std::span<const PicturedRoute> routes, double y) {
  for (std::size_t i = 0; i < routes.size(); ++i, y += 62) {
    const AE_navigator::Route& route = routes[i].route;
    svg.add(R"svg(<path d="M{0} {1:.0f}h26" stroke="{2}" stroke-width="4"
stroke-linecap="round"/><text x="{3}" y="{4:.0f}" class="small" font-weight="600">{5}</text>)svg",
            kLegendLeft, y - 4, route_colour(i), kLegendLeft + 36, y, escaped(routes[i].label));
    svg.add(R"svg(<text x="{}" y="{:.0f}" class="sub">{:.1f} km, exposure {:.1f} km</text>)svg",
            kLegendLeft + 36, y + 18, route.length_m / 1000, route.radar_exposure / 1000);
    svg.add(R"svg(<text x="{}" y="{:.0f}" class="sub">{}</text>)svg", kLegendLeft + 36, y + 35,
            drawable(route)
                ? fmt::format("at least {:.0f} m above ground", route.lowest_height_above_ground_m)
                : std::string("not drawn: not a route"));
  }
  if (routes.size() > 1) {
    svg.add(R"svg(<text x="{}" y="{:.0f}"
class="tick">Where routes run together their colours take turns.</text>)svg",
            kLegendLeft, y - 6);
    y += 20;
  }
  return y;
}

void add_ring_key(Svg& svg, const Symbol& symbol, const char* what, double y) {
  svg.add(R"svg(<circle cx="{0}" cy="{1:.0f}" r="8" fill="none" stroke="{2}"
stroke-width="1.4" stroke-dasharray="{3}"/><text x="{4}" y="{5:.0f}" class="small">{6}</text>)svg",
          kLegendLeft + 12, y - 4, symbol.colour, symbol.dashes, kLegendLeft + 36, y, what);
}

void add_key(Svg& svg, const Terrain& terrain, const AE_navigator::Problem& problem, double y) {
  svg.add(R"svg(<text x="{}" y="{:.0f}" class="small"
font-weight="600">Ground, {:.0f} m to {:.0f} m</text>)svg",
          kLegendLeft, y, terrain.lowest_m(), terrain.highest_m());
  for (int i = 0; i < 48; ++i) {
    const Colour c = height_colour(i / 47.0);
    svg.add(R"svg(<rect x="{:.1f}" y="{:.0f}" width="5.2" height="12"
fill="rgb({:.0f},{:.0f},{:.0f})"/>)svg",
            kLegendLeft + 5 * i, y + 9, 255 * c.red, 255 * c.green, 255 * c.blue);
  }
  y += 50;
  svg.add(R"svg(<text x="{}" y="{:.0f}" class="small"
font-weight="600">Seen by radar, {:.0f} m above ground</text>)svg",
          kLegendLeft, y, problem.minimum_height_above_ground_m);
  for (int i = 0; i < 48; ++i) {
    svg.add(R"svg(<rect x="{:.1f}" y="{:.0f}" width="5.2" height="12" fill="#c70d38"
fill-opacity="{:.2f}"/>)svg",
            kLegendLeft + 5 * i, y + 9, 0.6 * i / 47);
  }
  svg.add(R"svg(<text x="{0}" y="{1:.0f}" class="tick">hardly</text><text x="{2}" y="{1:.0f}"
class="tick" text-anchor="end">strongly</text>)svg",
          kLegendLeft, y + 36, kLegendLeft + 240);
  y += 62;
  add_ring_key(svg, kRadar, "range of a radar", y);
  if (!problem.missile_sites.empty()) add_ring_key(svg, kMissiles, "range of missiles", y += 28);
  y += 28;
  svg.add(R"svg(<g opacity="0.6"><rect x="{0}" y="{1:.0f}" width="24" height="14" fill="#f3c6c6"
stroke="#8f0d1c" stroke-width="2"/><rect x="{0}" y="{1:.0f}" width="24" height="14"
fill="url(#hatch)"/></g><text x="{2}" y="{3:.0f}" class="small">no-fly zone</text>)svg",
          kLegendLeft, y - 12, kLegendLeft + 36, y);
}

}  // namespace

std::string route_picture(const Terrain& terrain, const AE_navigator::Problem& problem,
                          std::span<const PicturedRoute> routes, const std::string& title) {
  const MapScale map(terrain);
  const auto profiles = static_cast<double>(std::count_if(
      routes.begin(), routes.end(), [](const auto& pictured) { return drawable(pictured.route); }));
  const double legend_height = 62.0 * static_cast<double>(routes.size()) + 298;
  const double below_map = kMapTop + std::max(map.height(), legend_height) + 34;
  Svg svg;
  add_head(svg, title, terrain, below_map + profiles * kProfileHeight + 16);
  add_ground(svg, terrain, problem, map);
  svg.add(R"svg(<g clip-path="url(#map)">)svg");
  for (const auto& zone : problem.no_fly_zones) add_zone(svg, zone, map);
  for (const auto& radar : problem.radar_sites)
    add_site(svg, kRadar, radar.site, radar.range_m, map);
  for (const auto& missiles : problem.missile_sites)
    add_site(svg, kMissiles, missiles.site, missiles.range_m, map);
  add_routes(svg, routes, map);
  add_names(svg, problem, map);
  add_end(svg, "Start", problem.start, "#2b8a3e", map);
  add_end(svg, "Goal", problem.goal, "#111827", map);
  svg.add("</g>");
  add_scale_and_north(svg, terrain, map);
  add_frame(svg, terrain, map);
  const double key = add_route_legend(svg, routes, kMapTop + 16);
  add_key(svg, terrain, problem, key + 18);
  add_profiles(svg, terrain, problem, routes, kMapLeft, below_map, kWidth - kMapLeft - 40);
  svg.add("</svg>");
  return svg.take();
}

void write_route_picture(const std::filesystem::path& file, const Terrain& terrain,
                         const AE_navigator::Problem& problem,
                         std::span<const PicturedRoute> routes, const std::string& title) {
  write_whole_file("the picture", file, route_picture(terrain, problem, routes, title));
}

void try_route_picture(const std::filesystem::path& file) { try_whole_file("the picture", file); }

}  // namespace skein::navigation
