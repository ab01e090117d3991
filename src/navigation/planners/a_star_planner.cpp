#include "navigation/grid/graph_search.hpp"
#include "navigation/planners/route_making.hpp"
#include "navigation/planners/search.hpp"
#include "navigation/planners/surface_graph.hpp"

namespace skein::navigation {
namespace {

constexpr int kMaxGridPoints = 100;

AE_navigator::Route search_on(const PlanningScene& scene, Berth berth) {
  const SurfaceGraph graph(scene, berth);
  const grid::SearchResult found = grid::find_cheapest_path(graph, graph.start(), graph.goal(),
                                                            [&] { return scene.budget().spent(); });
  if (found.end == grid::SearchEnd::Unreachable) {
    if (berth == Berth::ForTurns) throw Unflyable("there is no room for turns");
    throw AE_navigator::NoRoute(graph.explain_separation(), true);
  }
  scene.budget().require_time();
  GroundPath path;
  for (const int node : found.path.nodes) path.push_back(graph.point(node));
  const auto cost = [&](const GroundPoint& a, const GroundPoint& b) { return scene.cost(a, b); };
  return make_route(scene, path, cost, kMaxGridPoints, "AStar");
}

}  // namespace

AE_navigator::Route search_a_star(const Search& search) {
  const PlanningScene scene(search);
  std::string why_not;
  try {
    return search_on(scene, Berth::Least);
  } catch (const Unflyable& reason) {
    why_not = reason.what();
  }
  // The cheapest path has bends too tight for the aircraft; with room for turns there may be
  // another.
  try {
    return search_on(scene, Berth::ForTurns);
  } catch (const Unflyable&) {
    throw AE_navigator::NoRoute("the cheapest path cannot be flown: " + why_not, false);
  }
}

}  // namespace skein::navigation
