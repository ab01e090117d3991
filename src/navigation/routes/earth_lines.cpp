#include "navigation/routes/earth_lines.hpp"

#include <fmt/core.h>

#include <algorithm>

#include "navigation/terrain/plane_geometry.hpp"
#include "skein/error.hpp"

namespace skein::navigation {
namespace {

constexpr double kPiece_m = 2000;

bool same(const EarthPosition& a, const EarthPosition& b) {
  return a.longitude_deg == b.longitude_deg && a.latitude_deg == b.latitude_deg;
}

/// Ten-millionths of a degree, a centimetre: neighbours that become one are one.
void add(EarthLine& line, EarthPosition position) {
  position.longitude_deg = std::round(position.longitude_deg * 1e7) / 1e7;
  position.latitude_deg = std::round(position.latitude_deg * 1e7) / 1e7;
  if (line.empty() || !same(line.back(), position)) line.push_back(position);
}

/// Its longitude is the one nearest to its neighbour's.
void go_to(EarthLine& line, const EarthFrame& frame, const GroundPoint& point, double altitude_m) {
  const EarthPlace place = frame.to_earth(point);
  EarthPosition position{place.longitude_deg, place.latitude_deg, altitude_m};
  if (!line.empty()) {
    const double before = line.back().longitude_deg;
    position.longitude_deg = before + std::remainder(place.longitude_deg - before, 360);
  }
  add(line, position);
}

EarthPosition earth_between(const EarthPosition& a, const EarthPosition& b, double share) {
  return {std::lerp(a.longitude_deg, b.longitude_deg, share),
          std::lerp(a.latitude_deg, b.latitude_deg, share),
          std::lerp(a.altitude_m, b.altitude_m, share)};
}

/// The meridian, of 180 + 360 n, that a line of less than 180 degrees crosses; NaN for none.
double crossed_meridian(const EarthLine& line) {
  const auto [west, east] = std::minmax_element(line.begin(), line.end(),
                                                [](const EarthPosition& a, const EarthPosition& b) {
                                                  return a.longitude_deg < b.longitude_deg;
                                                });
  const double meridian = 360 * std::floor((west->longitude_deg + 180) / 360) + 180;
  return meridian < east->longitude_deg ? meridian : std::nan("");
}

/// Longitudes between -180 and 180 of a line on one side of the antimeridian.
void turn_back(EarthLine& line) {
  double middle = 0;
  for (const EarthPosition& position : line) {
    middle += position.longitude_deg / static_cast<double>(line.size());
  }
  const double turn = 360 * std::floor((middle + 180) / 360);
  for (EarthPosition& position : line) position.longitude_deg -= turn;
}

/// A line's parts on either side of a meridian, each with its ends on it.
std::vector<EarthLine> split(const EarthLine& line, double meridian) {
  std::vector<EarthLine> parts(1);
  for (const EarthPosition& position : line) {
    EarthLine& part = parts.back();
    if (!part.empty() &&
        (part.back().longitude_deg > meridian) != (position.longitude_deg > meridian)) {
      const EarthPosition& before = part.back();
      EarthPosition crossing = earth_between(
          before, position,
          (meridian - before.longitude_deg) / (position.longitude_deg - before.longitude_deg));
      crossing.longitude_deg = meridian;
      add(part, crossing);
      parts.emplace_back();
      add(parts.back(), crossing);
    }
    // After a crossing the part has the position on the meridian alone.
    add(parts.back(), position);
  }
  return parts;
}

/// Twice the area, positive against the clock.
double area(const EarthLine& ring) {
  double sum = 0;
  for (std::size_t i = 0; i < ring.size(); ++i) {
    const EarthPosition& a = ring[i];
    const EarthPosition& b = ring[(i + 1) % ring.size()];
    sum += a.longitude_deg * b.latitude_deg - b.longitude_deg * a.latitude_deg;
  }
  return sum;
}

/// Puts the chains of an outline on one side of a meridian together. Along the meridian the inside
/// lies between the first and the second of the chains' ends from the south, the third and the
/// fourth, and so on.
std::vector<EarthLine> join(std::vector<EarthLine> chains) {
  std::vector<double> ends;
  for (const EarthLine& chain : chains) {
    ends.push_back(chain.front().latitude_deg);
    ends.push_back(chain.back().latitude_deg);
  }
  std::sort(ends.begin(), ends.end());
  const auto partner = [&](double latitude) {
    const auto at = std::lower_bound(ends.begin(), ends.end(), latitude) - ends.begin();
    return ends[static_cast<std::size_t>(at % 2 == 0 ? at + 1 : at - 1)];
  };
  std::vector<EarthLine> rings;
  while (!chains.empty()) {
    EarthLine ring = std::move(chains.back());
    chains.pop_back();
    for (double next = partner(ring.back().latitude_deg); next != ring.front().latitude_deg;
         next = partner(ring.back().latitude_deg)) {
      const auto chain = std::find_if(chains.begin(), chains.end(), [&](const EarthLine& other) {
        return other.front().latitude_deg == next;
      });
      if (chain == chains.end()) break;
      ring.insert(ring.end(), chain->begin(), chain->end());
      chains.erase(chain);
    }
    rings.push_back(std::move(ring));
  }
  return rings;
}

}  // namespace

const EarthFrame& frame_of(const Terrain& terrain) {
  if (terrain.frame()) return *terrain.frame();
  throw InvalidArgument(fmt::format(
      "terrain '{}' is invented and lies nowhere on the earth; only what lies on the terrain of a "
      "tile has latitudes and longitudes",
      terrain.name()));
}

EarthLine along(const EarthFrame& frame, std::span<const AE_navigator::Position> points) {
  EarthLine line;
  const auto pass = [&](const AE_navigator::Position& point) {
    go_to(line, frame, on_map(point), point.altitude_m);
  };
  for (std::size_t i = 0; i < points.size(); ++i) {
    const AE_navigator::Position& from = points[i == 0 ? 0 : i - 1];
    const double length_m = distance_m(on_map(from), on_map(points[i]));
    const int pieces = std::max(1, static_cast<int>(std::ceil(length_m / kPiece_m)));
    for (int piece = 1; piece < pieces; ++piece) {
      pass(navigation::between(from, points[i], static_cast<double>(piece) / pieces));
    }
    pass(points[i]);
  }
  return line;
}

EarthLine between_corners(const EarthFrame& frame,
                          std::span<const AE_navigator::GroundPoint> corners) {
  EarthLine line;
  for (const auto& corner : corners) go_to(line, frame, corner, 0);
  return line;
}

std::vector<EarthLine> cut_line(const EarthLine& line) {
  const double meridian = crossed_meridian(line);
  std::vector<EarthLine> parts =
      std::isnan(meridian) ? std::vector<EarthLine>{line} : split(line, meridian);
  std::erase_if(parts, [&](const EarthLine& part) { return part.size() < 2 && parts.size() > 1; });
  for (EarthLine& part : parts) turn_back(part);
  return parts;
}

std::vector<EarthLine> cut_outline(EarthLine outline) {
  if (outline.size() > 1 && same(outline.front(), outline.back())) outline.pop_back();
  const double meridian = crossed_meridian(outline);
  std::vector<EarthLine> rings;
  if (std::isnan(meridian)) {
    rings = {std::move(outline)};
  } else {
    // Begin where it comes over the meridian, so that every part is a whole chain.
    const auto is_east = [&](const EarthPosition& position) {
      return position.longitude_deg > meridian;
    };
    std::size_t first = 0;
    while (is_east(outline[first]) || !is_east(outline[(first + 1) % outline.size()])) ++first;
    std::rotate(outline.begin(), outline.begin() + static_cast<std::ptrdiff_t>(first),
                outline.end());
    outline.push_back(outline.front());
    std::vector<EarthLine> parts = split(outline, meridian);
    // The first part is the beginning of the last.
    parts.back().insert(parts.back().end(), parts.front().begin() + 1, parts.front().end());
    parts.erase(parts.begin());
    std::vector<EarthLine> east, west;
    for (EarthLine& part : parts) {
      const bool eastern = std::any_of(part.begin(), part.end(), is_east);
      (eastern ? east : west).push_back(std::move(part));
    }
    rings = join(std::move(east));
    std::ranges::move(join(std::move(west)), std::back_inserter(rings));
  }
  for (EarthLine& ring : rings) {
    if (ring.size() > 1 && same(ring.front(), ring.back())) ring.pop_back();
    turn_back(ring);
    if (area(ring) < 0) std::reverse(ring.begin(), ring.end());
    ring.push_back(ring.front());
  }
  return rings;
}

}  // namespace skein::navigation
