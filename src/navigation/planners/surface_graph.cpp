#include "navigation/planners/surface_graph.hpp"

#include <fmt/core.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>

namespace skein::navigation {
namespace {

/// Of all moves the longest spans three nodes and two across.
constexpr double kLongestMove = 3.7;

/// Start and goal are joined to the nodes no further away than this many nodes.
constexpr double kAround = 2.6;

}  // namespace

SurfaceGraph::SurfaceGraph(const PlanningScene& scene, Berth berth)
    : scene_(scene),
      berth_(berth),
      near_zone_(static_cast<std::size_t>(scene.grid().size()), 0),
      risky_(scene.fears_threats()) {
  const int kMoves[][2] = {{1, 0}, {1, 1}, {2, 1}, {3, 1}, {3, 2}};
  for (const auto& [far, near] : kMoves) {
    for (int mirror = 0; mirror < 8; ++mirror) {
      const int along = mirror & 1 ? -far : far;
      const int across = mirror & 2 ? -near : near;
      const int rows = mirror & 4 ? across : along;
      const int columns = mirror & 4 ? along : across;
      if ((near == 0 && mirror & 2) || (near == far && mirror & 4)) continue;
      Move move{rows, columns, {}};
      for (int step = 0; step < far; ++step) {
        // The cell between two steps along the longer side, as its four nodes.
        const int low = step * near / far;
        const int high = (step * near + near + far - 1) / far;
        for (const int side : {low, high}) {
          for (const int forward : {step, step + 1}) {
            const int along_s = along < 0 ? -forward : forward;
            const int across_s = across < 0 ? -side : side;
            move.passed.push_back(mirror & 4 ? std::array{across_s, along_s}
                                             : std::array{along_s, across_s});
          }
        }
      }
      std::sort(move.passed.begin(), move.passed.end());
      move.passed.erase(std::unique(move.passed.begin(), move.passed.end()), move.passed.end());
      moves_.push_back(std::move(move));
    }
  }
  const double near = kLongestMove * scene.grid().spacing_m();
  for (int node = 0; node < scene.grid().size(); ++node) {
    const GroundPoint point = scene.grid().point(node);
    for (const KeepOut& zone : scene.keep_outs(berth)) {
      char& mark = near_zone_[static_cast<std::size_t>(node)];
      if (mark < 2 && zone.distance_m(point) <= near) {
        mark = scene.zone_across(point, point, berth) ? 2 : 1;
      }
    }
  }
  if (risky_) {
    end_rates_[0] = scene.risk().rate(on_map(scene.problem().start));
    end_rates_[1] = scene.risk().rate(on_map(scene.problem().goal));
  }
  around_[0] = nodes_around(start());
  around_[1] = nodes_around(goal());
}

GroundPoint SurfaceGraph::point(int node) const {
  if (node == start()) return on_map(scene_.problem().start);
  if (node == goal()) return on_map(scene_.problem().goal);
  return scene_.grid().point(node);
}

double SurfaceGraph::rate(int node) const {
  if (!risky_) return 0;
  return node < scene_.grid().size() ? scene_.risk().rate(node) : end_rates_[node == goal()];
}

double SurfaceGraph::cost(const GroundPoint& from, int to, double rate_from) const {
  const GroundPoint end = point(to);
  const double length = distance_m(from, end);
  if (!risky_) return length;
  const double rate_between = scene_.risk().rate(between(from, end, 0.5));
  return length + (rate_from + 4 * rate_between + rate(to)) * length / 6;
}

int SurfaceGraph::follow(int node, const Move& move) const {
  const PlanningGrid& grid = scene_.grid();
  const int row = grid.row(node);
  const int column = grid.column(node);
  if (!grid.has(row + move.rows, column + move.columns)) return -1;
  const int to = grid.node(row + move.rows, column + move.columns);
  if (blocked_by_zone(to)) return -1;
  for (const auto& [rows, columns] : move.passed) {
    if (!scene_.surface().open(grid.node(row + rows, column + columns), berth_)) return -1;
  }
  if (near_zone_[static_cast<std::size_t>(node)] &&
      scene_.zone_across(grid.point(node), grid.point(to), berth_)) {
    return -1;
  }
  return to;
}

std::vector<int> SurfaceGraph::nodes_around(int end) const {
  const PlanningGrid& grid = scene_.grid();
  const GroundPoint middle = point(end);
  const int south_west = grid.cell(middle).south_west;
  std::vector<int> result;
  for (int row = grid.row(south_west) - 3; row <= grid.row(south_west) + 4; ++row) {
    for (int column = grid.column(south_west) - 3; column <= grid.column(south_west) + 4;
         ++column) {
      if (!grid.has(row, column)) continue;
      const int node = grid.node(row, column);
      if (distance_m(middle, grid.point(node)) > kAround * grid.spacing_m()) continue;
      if (scene_.surface().open(node, berth_) &&
          !scene_.zone_across(middle, grid.point(node), berth_)) {
        result.push_back(node);
      }
    }
  }
  const int other = end == start() ? goal() : start();
  if (distance_m(middle, point(other)) <= kAround * grid.spacing_m() &&
      !scene_.zone_across(middle, point(other), berth_)) {
    result.push_back(other);
  }
  return result;
}

SurfaceGraph::Region SurfaceGraph::region_around(int end) const {
  const PlanningGrid& grid = scene_.grid();
  Region region;
  std::vector<bool> seen(static_cast<std::size_t>(node_count()), false);
  std::vector<int> open{end};
  seen[static_cast<std::size_t>(end)] = true;
  while (!open.empty()) {
    const int node = open.back();
    open.pop_back();
    ++region.nodes;
    for_each_edge(node, [&](int to, double) {
      if (seen[static_cast<std::size_t>(to)]) return;
      seen[static_cast<std::size_t>(to)] = true;
      open.push_back(to);
    });
    const int middle = node < grid.size() ? node : grid.cell(point(node)).south_west;
    for (const Move& move : moves_) {
      const int row = grid.row(middle) + move.rows;
      const int column = grid.column(middle) + move.columns;
      if (!grid.has(row, column)) continue;
      const int to = grid.node(row, column);
      if (const KeepOut* zone = scene_.zone_across(point(node), grid.point(to), berth_)) {
        region.zones.insert(zone->name());
      } else if (!scene_.surface().open(to, berth_)) {
        region.ground = true;
      }
    }
  }
  return region;
}

std::string SurfaceGraph::explain_separation() const {
  const Region start_region = region_around(start());
  const Region goal_region = region_around(goal());
  const bool goal_is_smaller = goal_region.nodes <= start_region.nodes;
  const Region& region = goal_is_smaller ? goal_region : start_region;
  const double area_km2 =
      region.nodes * scene_.grid().north_spacing_m() * scene_.grid().east_spacing_m() / 1e6;
  std::string walls;
  if (!region.zones.empty()) {
    walls = fmt::format("the no-fly zone{} '{}'", region.zones.size() > 1 ? "s" : "",
                        fmt::join(region.zones, "', '"));
  }
  if (region.ground) {
    walls += walls.empty() ? "" : " and by ";
    walls += "ground too high or too steep to climb";
  }
  return fmt::format(
      "there is no route: the {} is enclosed by {}; {:.1f} km2 around it are free (proved on a "
      "grid "
      "of {:.0f} m)",
      goal_is_smaller ? "goal" : "start", walls, area_km2, scene_.grid().spacing_m());
}

}  // namespace skein::navigation
