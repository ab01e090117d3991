#include "navigation/planners/path_hybridisation.hpp"

#include <algorithm>
#include <limits>

#include "navigation/grid/graph_search.hpp"
#include "navigation/planners/route_making.hpp"

namespace skein::navigation {
namespace {

using AE_navigator::Problem;
using AE_navigator::Route;

constexpr int kPointsOfARoute = 60;
constexpr int kMaxHybridPoints = 100;
// How many of a route's steps a leg from one route to another may be long.
constexpr double kReach = 4;

double cost_m(const Problem& problem, const Route& route) {
  return route.length_m + problem.exposure_weight * route.radar_exposure +
         problem.kill_weight_m * route.expected_kills;
}

/// The points of all routes, joined by free legs: along each route, and to what is near.
class RouteGraph {
 public:
  RouteGraph(const PlanningScene& scene, const std::vector<Route>& routes) : scene_(scene) {
    for (std::size_t i = 0; i < routes.size(); ++i) {
      const double step_m =
          std::max(scene.grid().spacing_m(), routes[i].length_m / kPointsOfARoute);
      GroundPath path;
      for (const auto& waypoint : routes[i].waypoints) path.push_back(on_map(waypoint));
      for (const GroundPoint& point : divide(thin(scene, path, step_m), step_m))
        points_.push_back({point, i, step_m});
    }
  }

  int start() const { return 0; }
  int goal() const { return node_count() - 1; }
  int node_count() const { return static_cast<int>(points_.size()); }
  const GroundPoint& point(int node) const { return at(node).place; }
  std::size_t route(int node) const { return at(node).route; }

  /// The straight distance: what threats cost is never negative.
  double lower_bound(int node) const { return distance_m(point(node), point(goal())); }

  template <class Visit>
  void for_each_edge(int node, Visit&& visit) const {
    const Point& from = at(node);
    for (int to = 0; to < node_count(); ++to) {
      const Point& other = at(to);
      const bool next = from.route == other.route && std::abs(to - node) == 1;
      if (to == node || (!next && distance_m(from.place, other.place) > kReach * from.step_m))
        continue;
      if (scene_.free(from.place, other.place, Berth::Least))
        visit(to, scene_.cost(from.place, other.place));
    }
  }

 private:
  struct Point {
    GroundPoint place;
    std::size_t route;
    double step_m;
  };
  const Point& at(int node) const { return points_[static_cast<std::size_t>(node)]; }

  const PlanningScene& scene_;
  std::vector<Point> points_;
};

/// `AStar + RRTConnect`: whose points the path has, in its order.
std::string names_of(const std::vector<std::size_t>& flown, const std::vector<Route>& routes) {
  std::vector<std::string> names;
  for (const std::size_t route : flown) {
    const std::string& name = routes[route].planner;
    if (std::find(names.begin(), names.end(), name) == names.end()) names.push_back(name);
  }
  std::string text;
  for (const std::string& name : names) text += (text.empty() ? "" : " + ") + name;
  return text;
}

}  // namespace

std::optional<Route> hybridise(TerrainProvider& terrains, const Problem& problem,
                               const std::vector<Route>& routes, const PlannerOptions& options) {
  const PlanningScene scene(terrains, problem, options);
  double least_m = std::numeric_limits<double>::infinity();
  for (const Route& route : routes) least_m = std::min(least_m, cost_m(problem, route));
  try {
    const RouteGraph graph(scene, routes);
    if (graph.node_count() == 0) return std::nullopt;
    const auto found = grid::find_cheapest_path(graph, graph.start(), graph.goal(),
                                                [&] { return scene.budget().spent(); });
    if (found.end != grid::SearchEnd::Found) return std::nullopt;
    GroundPath path;
    std::vector<std::size_t> flown;
    for (const int node : found.path.nodes) {
      path.push_back(graph.point(node));
      flown.push_back(graph.route(node));
    }
    const auto cost = [&](const GroundPoint& a, const GroundPoint& b) { return scene.cost(a, b); };
    Route hybrid = make_route(scene, path, cost, kMaxHybridPoints, names_of(flown, routes));
    if (cost_m(problem, hybrid) < least_m) return hybrid;
  } catch (const Unflyable&) {
    // The parts fit together on the map alone.
  } catch (const AE_navigator::NoRoute&) {
    // The time is up.
  }
  return std::nullopt;
}

}  // namespace skein::navigation
