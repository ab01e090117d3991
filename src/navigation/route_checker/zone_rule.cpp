#include <algorithm>
#include <cmath>
#include <complex>
#include <numbers>
#include <optional>
#include <vector>

#include "rules.hpp"

namespace skein::navigation::route_checker {
namespace {

/// Points of the map as complex numbers, east being real.
using Point = std::complex<double>;

double cross(const Point& a, const Point& b) { return std::imag(std::conj(a) * b); }
double dot(const Point& a, const Point& b) { return std::real(std::conj(a) * b); }

/// How often the outline runs around the point; every odd and even number but 0 is inside.
bool is_inside(const std::vector<Point>& outline, const Point& point) {
  int crossings = 0;
  for (std::size_t i = 0; i < outline.size(); ++i) {
    const Point a = outline[i] - point;
    const Point b = outline[(i + 1) % outline.size()] - point;
    // A ray to the east.
    if ((a.imag() <= 0) != (b.imag() <= 0) && (cross(a, b) > 0) == (b.imag() > a.imag()))
      ++crossings;
  }
  return crossings % 2 == 1;
}

/// The share of p-q at which it comes within `radius` of the point, if it does.
std::optional<double> entry_into_disc(const Point& p, const Point& q, const Point& middle,
                                      double radius) {
  const Point d = q - p;
  const Point f = p - middle;
  const double c = std::norm(f) - radius * radius;
  if (c < 0) return 0;
  const double a = std::norm(d);
  const double b = dot(f, d);
  const double root = b * b - a * c;
  if (a == 0 || root <= 0) return std::nullopt;
  const double share = (-b - std::sqrt(root)) / a;
  return share >= 0 && share < 1 ? std::optional(share) : std::nullopt;
}

/// The share of p-q at which it enters the strip of that half width around a-b, between
/// perpendiculars at its ends.
std::optional<double> entry_into_strip(const Point& p, const Point& q, const Point& a,
                                       const Point& b, double half_width) {
  const double length = std::abs(b - a);
  if (length == 0) return std::nullopt;
  const Point axis = (b - a) / length;
  double from = 0;
  double to = 1;
  const auto clip = [&](double start, double change, double low, double high) {
    if (change == 0) {
      if (start <= low || start >= high) to = -1;
      return;
    }
    const double one = (low - start) / change;
    const double other = (high - start) / change;
    from = std::max(from, std::min(one, other));
    to = std::min(to, std::max(one, other));
  };
  clip(dot(axis, p - a), dot(axis, q - p), 0, length);
  clip(cross(axis, p - a), cross(axis, q - p), -half_width, half_width);
  return from < to ? std::optional(from) : std::nullopt;
}

/// The first piece of p-q, between its crossings of the outline, that is inside.
std::optional<double> entry_into_polygon(const Point& p, const Point& q,
                                         const std::vector<Point>& outline) {
  std::vector<double> cuts{0, 1};
  for (std::size_t i = 0; i < outline.size(); ++i) {
    const Point& a = outline[i];
    const Point edge = outline[(i + 1) % outline.size()] - a;
    const double denominator = cross(q - p, edge);
    if (denominator == 0) continue;
    const double share = cross(a - p, edge) / denominator;
    if (share > 0 && share < 1) cuts.push_back(share);
  }
  std::sort(cuts.begin(), cuts.end());
  for (std::size_t i = 1; i < cuts.size(); ++i) {
    if (cuts[i] - cuts[i - 1] < 1e-12) continue;
    if (is_inside(outline, p + (cuts[i - 1] + cuts[i]) / 2 * (q - p))) return cuts[i - 1];
  }
  return std::nullopt;
}

}  // namespace

double entry_into(const AE_navigator::NoFlyZone& zone, const AE_navigator::Position& a,
                  const AE_navigator::Position& b) {
  // The part of the edge between floor and ceiling.
  double from = 0;
  double to = 1;
  const double climb = b.altitude_m - a.altitude_m;
  if (climb != 0) {
    const double at_floor = (zone.floor_m - a.altitude_m) / climb;
    const double at_ceiling = (zone.ceiling_m - a.altitude_m) / climb;
    from = std::max(from, std::min(at_floor, at_ceiling));
    to = std::min(to, std::max(at_floor, at_ceiling));
  } else if (a.altitude_m <= zone.floor_m || a.altitude_m >= zone.ceiling_m) {
    return -1;
  }
  if (from >= to) return -1;

  const Point whole_p(a.east_m, a.north_m);
  const Point whole_q(b.east_m, b.north_m);
  const Point p = whole_p + from * (whole_q - whole_p);
  const Point q = whole_p + to * (whole_q - whole_p);
  std::vector<Point> outline;
  for (const auto& corner : zone.outline) outline.emplace_back(corner.east_m, corner.north_m);

  std::optional<double> first;
  const auto consider = [&](const std::optional<double>& entry) {
    if (entry && (!first || *entry < *first)) first = entry;
  };
  if (outline.size() > 2) consider(entry_into_polygon(p, q, outline));
  for (std::size_t i = 0; i < outline.size() && zone.margin_m > 0; ++i) {
    consider(entry_into_disc(p, q, outline[i], zone.margin_m));
    consider(entry_into_strip(p, q, outline[i], outline[(i + 1) % outline.size()], zone.margin_m));
  }
  return first ? from + *first * (to - from) : -1;
}

}  // namespace skein::navigation::route_checker
