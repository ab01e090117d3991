#include "navigation/grid/grid_planner.hpp"

#include <cmath>

#include "core/suggestion.hpp"
#include "grid_algorithms.hpp"
#include "skein/error.hpp"

namespace skein::navigation::grid {
namespace {

struct Maker {
  const char* name;
  std::unique_ptr<GridPlanner> (*make)(SharedMap);
  bool in_spaces;
};

constexpr Maker kMakers[] = {
    {"astar", make_plain_a_star, true},         {"canonical-astar", make_canonical_a_star, true},
    {"landmarks", make_landmark_a_star, false}, {"jps", make_jump_point_search, false},
    {"theta", make_lazy_theta_star, false},
};

}  // namespace

std::optional<GridPath> GridPlanner::plan(const Cell& start, const Cell& goal) {
  if (!map_->is_free(start) || !map_->is_free(goal)) return std::nullopt;
  if (start == goal) return GridPath{0, {start}};
  return find_path(start, goal);
}

std::vector<std::string> grid_planner_names(const GridMap& map) {
  std::vector<std::string> names;
  for (const Maker& maker : kMakers) {
    if (map.is_plane() || maker.in_spaces) names.emplace_back(maker.name);
  }
  return names;
}

std::unique_ptr<GridPlanner> make_grid_planner(std::string_view name, const SharedMap& map) {
  for (const Maker& maker : kMakers) {
    if (name == maker.name && (map->is_plane() || maker.in_spaces)) return maker.make(map);
  }
  const std::vector<std::string> names = grid_planner_names(*map);
  std::string known;
  for (const std::string& other : names) known += (known.empty() ? "" : ", ") + other;
  throw InvalidArgument("there is no planner '" + std::string(name) + "' for a " +
                        (map->is_plane() ? "plane" : "space") + suggestion(name, names) +
                        "; known are " + known);
}

double length_of(const std::vector<Cell>& corners) {
  double length = 0;
  for (std::size_t i = 1; i < corners.size(); ++i) {
    const Cell& a = corners[i - 1];
    const Cell& b = corners[i];
    length += std::hypot(a.x - b.x, a.y - b.y, a.z - b.z);
  }
  return length;
}

}  // namespace skein::navigation::grid
