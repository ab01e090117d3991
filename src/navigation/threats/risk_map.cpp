#include "navigation/threats/risk_map.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "navigation/threats/radar_exposure.hpp"

namespace skein::navigation {
namespace {

/// Visits the nodes at a distance of `ring` from the middle, measured in rows or columns, whichever
/// are more; false where none of them is on the grid.
template <class Visit>
bool visit_ring(const PlanningGrid& grid, int middle_row, int middle_column, int ring,
                Visit&& visit) {
  bool any = false;
  const auto maybe_visit = [&](int rows, int columns) {
    if (!grid.has(middle_row + rows, middle_column + columns)) return;
    any = true;
    visit(rows, columns);
  };
  for (int step = -ring; step <= ring; ++step) {
    maybe_visit(-ring, step);
    maybe_visit(ring, step);
  }
  for (int step = 1 - ring; step < ring; ++step) {
    maybe_visit(step, -ring);
    maybe_visit(step, ring);
  }
  return any;
}

}  // namespace

RiskMap::RiskMap(const Terrain& terrain, const PlanningGrid& grid,
                 const std::vector<float>& altitudes_m)
    : terrain_(terrain),
      altitudes_m_(altitudes_m),
      grid_(grid),
      rates_(static_cast<std::size_t>(grid.size()), 0) {}

void RiskMap::add(std::span<const AE_navigator::RadarSite> sites, double weight) {
  for (const auto& site : sites) {
    add_site(site.site, site.mast_height_m, [&](double slant_m) {
      return weight * exposure_rate(site.range_m, site.strength, slant_m);
    });
  }
}

void RiskMap::add(std::span<const AE_navigator::MissileSite> sites, double weight) {
  for (const auto& site : sites) {
    add_site(site.site, site.mast_height_m, [&](double slant_m) {
      return slant_m < site.range_m ? weight * site.kills_per_second : 0;
    });
  }
}

template <class Rate>
void RiskMap::add_site(const GroundPoint& site, double mast_height_m, const Rate& rate_at) {
  if (ground_m_.empty()) {
    for (int node = 0; node < grid_.size(); ++node) {
      const GroundPoint point = grid_.point(node);
      ground_m_.push_back(static_cast<float>(terrain_.height_m(point.north_m, point.east_m)));
    }
  }
  const double antenna_altitude_m = mast_top(terrain_, site, mast_height_m).altitude_m;
  const int middle_row = static_cast<int>(std::lround(site.north_m / grid_.north_spacing_m()));
  const int middle_column = static_cast<int>(std::lround(site.east_m / grid_.east_spacing_m()));
  constexpr float kNothing = std::numeric_limits<float>::lowest();
  std::vector<float> horizon(rates_.size(), kNothing);  // Steepest slope up to and at the node.

  const auto horizon_before = [&](int rows, int columns, int ring) {
    if (ring <= 1) return kNothing;
    // Where the line to the middle crosses the ring before: between two of its nodes.
    const double shrink = (ring - 1.0) / ring;
    const bool by_row = std::abs(rows) == ring;
    const double place = (by_row ? columns : rows) * shrink;
    const int low = static_cast<int>(std::floor(place));
    const int high = std::min(low + 1, ring - 1);
    const int inward =
        by_row ? (rows > 0 ? ring - 1 : 1 - ring) : (columns > 0 ? ring - 1 : 1 - ring);
    const auto at = [&](int along) {
      const int row = middle_row + (by_row ? inward : along);
      const int column = middle_column + (by_row ? along : inward);
      return horizon[static_cast<std::size_t>(grid_.node(row, column))];
    };
    const double share = place - low;
    if (share == 0) return at(low);
    const float one = at(low);
    const float other = at(high);
    if (one == kNothing || other == kNothing) return std::max(one, other);
    return static_cast<float>((1 - share) * one + share * other);
  };

  const auto visit = [&](int ring, int rows, int columns) {
    const auto node =
        static_cast<std::size_t>(grid_.node(middle_row + rows, middle_column + columns));
    const GroundPoint point = grid_.point(static_cast<int>(node));
    const double distance = std::max(1.0, distance_m(point, site));
    const double base = antenna_altitude_m + earth_drop_m(distance);
    const float before = horizon_before(rows, columns, ring);
    const double above = altitudes_m_[node] - base;
    if (above / distance >= before) {
      rates_[node] += static_cast<float>(rate_at(std::hypot(distance, above)));
    }
    horizon[node] = std::max(before, static_cast<float>((ground_m_[node] - base) / distance));
  };
  // The antenna's own node is its foot, which hides nothing.
  visit(0, 0, 0);
  horizon[static_cast<std::size_t>(grid_.node(middle_row, middle_column))] = kNothing;
  for (int ring = 1;; ++ring) {
    const bool any = visit_ring(grid_, middle_row, middle_column, ring,
                                [&](int rows, int columns) { visit(ring, rows, columns); });
    if (!any) break;
  }
}

double RiskMap::along(const GroundPoint& a, const GroundPoint& b) const {
  const double length = distance_m(a, b);
  const int pieces = std::max(1, static_cast<int>(std::lround(length / grid_.spacing_m())));
  double sum = rate(a) + rate(b);
  for (int i = 1; i < 2 * pieces; ++i) {
    sum += (i % 2 == 1 ? 4 : 2) * rate(between(a, b, i / (2.0 * pieces)));
  }
  return sum * length / (6 * pieces);
}

}  // namespace skein::navigation
