#include "route_making.hpp"
#include "skein/navigation/grid_search.hpp"
#include "skein/navigation/planners.hpp"
#include "surface_graph.hpp"

namespace skein::navigation {
namespace {

constexpr int kMostPoints = 150;

class AStarPlanner final : public AE_navigator::IPlanner {
 public:
  AStarPlanner(std::shared_ptr<TerrainProvider> terrains, PlannerOptions options)
      : terrains_(std::move(terrains)), options_(std::move(options)) {}

  AE_navigator::Route plan(const AE_navigator::Problem& problem) override {
    const PlanningScene scene(*terrains_, problem, options_);
    const SurfaceGraph graph(scene);
    const SearchResult found = find_cheapest_path(graph, graph.start(), graph.goal(),
                                                  [&] { return scene.budget().spent(); });
    if (found.end == SearchEnd::Unreachable) {
      throw AE_navigator::NoRoute(graph.explain_separation());
    }
    scene.budget().require_time();
    GroundPath path;
    for (const int node : found.path.nodes) path.push_back(graph.point(node));
    try {
      const auto cost = [&](const GroundPoint& a, const GroundPoint& b) {
        return scene.cost(a, b);
      };
      return make_route(scene, path, cost, kMostPoints, "AStar");
    } catch (const Unflyable& reason) {
      throw AE_navigator::NoRoute(std::string("the cheapest path cannot be flown: ") +
                                  reason.what());
    }
  }

 private:
  std::shared_ptr<TerrainProvider> terrains_;
  PlannerOptions options_;
};

}  // namespace

std::unique_ptr<AE_navigator::IPlanner> make_a_star(std::shared_ptr<TerrainProvider> terrains,
                                                    PlannerOptions options) {
  return std::make_unique<AStarPlanner>(std::move(terrains), std::move(options));
}

}  // namespace skein::navigation
