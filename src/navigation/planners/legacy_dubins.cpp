#include <ompl/base/ScopedState.h>
#include <ompl/base/spaces/DubinsStateSpace.h>
#include <ompl/geometric/PathGeometric.h>
#include <ompl/geometric/planners/rrt/RRT.h>

#include <cmath>

#include "navigation/planners/planners.hpp"
#include "navigation/planners/problem_rules.hpp"
#include "navigation/planners/sampling.hpp"

namespace skein::navigation {
namespace {

namespace ob = ompl::base;
namespace og = ompl::geometric;

GroundPoint point_of_pose(const ob::State* state) {
  const auto* pose = state->as<ob::SE2StateSpace::StateType>();
  return {pose->getX(), pose->getY()};
}

/// A tree of the library's own Dubins paths. It aborts the process sooner or later: the library
/// checks what it has computed to an absolute 2e-6, and is built with assertions.
class LegacyDubinsPlanner final : public AE_navigator::IPlanner {
 public:
  LegacyDubinsPlanner(std::shared_ptr<TerrainProvider> terrains, PlannerOptions options)
      : terrains_(std::move(terrains)), options_(std::move(options)) {}

  AE_navigator::Route plan(const AE_navigator::Problem& problem) override {
    constexpr int kMaxPoints = 45;
    const PlanningScene scene(*terrains_, problem, options_);
    const ob::SpaceInformationPtr space = space_of(scene);
    const auto definition = std::make_shared<ob::ProblemDefinition>(space);
    definition->setStartAndGoalStates(pose_at(space, problem.start, problem),
                                      pose_at(space, problem.goal, problem));
    Seeded<og::RRT> planner(space, options_.seed);
    planner.setProblemDefinition(definition);
    const Instant end = scene.budget().search_end(0);
    const ob::PlannerStatus status = planner.solve(ob::PlannerTerminationCondition(
        [&] { return scene.budget().stopped() || scene.budget().now() >= end; }));
    scene.budget().require_time();
    if (status != ob::PlannerStatus::EXACT_SOLUTION) throw scene.budget().nothing_found();
    auto& solution = *definition->getSolutionPath()->as<og::PathGeometric>();
    solution.interpolate();
    GroundPath path;
    for (const ob::State* state : solution.getStates()) path.push_back(point_of_pose(state));
    const LegCost length = [](const GroundPoint& a, const GroundPoint& b) {
      return distance_m(a, b);
    };
    try {
      return make_route(scene, path, length, kMaxPoints, "LegacyDubins");
    } catch (const Unflyable& reason) {
      throw AE_navigator::NoRoute(reason.what(), false);
    }
  }

 private:
  static ob::SpaceInformationPtr space_of(const PlanningScene& scene) {
    const double radius = std::max(1.0, turn_radius_m(scene.problem().limits));
    const auto poses = std::make_shared<ob::DubinsStateSpace>(radius);
    ob::RealVectorBounds bounds(2);
    bounds.setLow(0);
    bounds.setHigh(0, scene.terrain().north_extent_m());
    bounds.setHigh(1, scene.terrain().east_extent_m());
    poses->setBounds(bounds);
    auto space = std::make_shared<ob::SpaceInformation>(poses);
    space->setStateValidityChecker([&scene](const ob::State* state) {
      return scene.free(point_of_pose(state), Berth::ForTurns);
    });
    space->setStateValidityCheckingResolution(scene.grid().spacing_m() / poses->getMaximumExtent());
    space->setup();
    return space;
  }

  /// The heading is that from the start to the goal.
  static ob::ScopedState<> pose_at(const ob::SpaceInformationPtr& space, const Position& position,
                                   const AE_navigator::Problem& problem) {
    ob::ScopedState<> pose(space);
    pose[0] = position.north_m;
    pose[1] = position.east_m;
    pose[2] = std::atan2(problem.goal.east_m - problem.start.east_m,
                         problem.goal.north_m - problem.start.north_m);
    return pose;
  }

  std::shared_ptr<TerrainProvider> terrains_;
  PlannerOptions options_;
};

}  // namespace

std::unique_ptr<AE_navigator::IPlanner> make_legacy_dubins(
    std::shared_ptr<TerrainProvider> terrains, PlannerOptions options) {
  return std::make_unique<LegacyDubinsPlanner>(std::move(terrains), std::move(options));
}

}  // namespace skein::navigation
