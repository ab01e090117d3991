#include "navigation/grid/graph_search.hpp"
#include "navigation/planners/planners.hpp"
#include "navigation/planners/route_making.hpp"
#include "navigation/planners/surface_graph.hpp"

namespace skein::navigation {
namespace {

constexpr int kMaxGridPoints = 100;

class AStarPlanner final : public AE_navigator::IPlanner {
 public:
  AStarPlanner(std::shared_ptr<TerrainProvider> terrains, PlannerOptions options)
      : terrains_(std::move(terrains)), options_(std::move(options)) {}

  AE_navigator::Route plan(const AE_navigator::Problem& problem) override {
    const PlanningScene scene(*terrains_, problem, options_);
    try {
      return plan_on(scene, Berth::Least);
    } catch (const Unflyable& reason) {
      return plan_wider(scene, reason.what());
    }
  }

 private:
  AE_navigator::Route plan_on(const PlanningScene& scene, Berth berth) const {
    const SurfaceGraph graph(scene, berth);
    const grid::SearchResult found = grid::find_cheapest_path(
        graph, graph.start(), graph.goal(), [&] { return scene.budget().spent(); });
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

  /// The cheapest path has bends too tight for the aircraft; with room for turns there may be
  /// another.
  AE_navigator::Route plan_wider(const PlanningScene& scene, const std::string& why_not) const {
    try {
      return plan_on(scene, Berth::ForTurns);
    } catch (const Unflyable&) {
      throw AE_navigator::NoRoute("the cheapest path cannot be flown: " + why_not, false);
    }
  }

  std::shared_ptr<TerrainProvider> terrains_;
  PlannerOptions options_;
};

}  // namespace

std::unique_ptr<AE_navigator::IPlanner> make_a_star(std::shared_ptr<TerrainProvider> terrains,
                                                    PlannerOptions options) {
  return std::make_unique<AStarPlanner>(std::move(terrains), std::move(options));
}

}  // namespace skein::navigation
