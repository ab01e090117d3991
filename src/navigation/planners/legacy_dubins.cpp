#include <ompl/base/ScopedState.h>
#include <ompl/base/spaces/DubinsStateSpace.h>
#include <ompl/geometric/PathGeometric.h>
#include <ompl/geometric/planners/rrt/RRT.h>

#include <cmath>

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

ob::SpaceInformationPtr space_of(const PlanningScene& scene) {
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
ob::ScopedState<> pose_at(const ob::SpaceInformationPtr& space, const Position& position,
                          const AE_navigator::Problem& problem) {
  ob::ScopedState<> pose(space);
  pose[0] = position.north_m;
  pose[1] = position.east_m;
  pose[2] = std::atan2(problem.goal.east_m - problem.start.east_m,
                       problem.goal.north_m - problem.start.north_m);
  return pose;
}

}  // namespace

/// It aborts the process sooner or later: the library checks what it has computed to an absolute
/// 2e-6, and is built with assertions.
AE_navigator::Route search_legacy_dubins(const Search& search) {
  constexpr int kMaxPoints = 45;
  const PlanningScene scene(search);
  const ob::SpaceInformationPtr space = space_of(scene);
  const auto definition = std::make_shared<ob::ProblemDefinition>(space);
  definition->setStartAndGoalStates(pose_at(space, search.problem.start, search.problem),
                                    pose_at(space, search.problem.goal, search.problem));
  Seeded<og::RRT> planner(space, search.options.seed);
  planner.setProblemDefinition(definition);
  const ob::PlannerStatus status =
      planner.solve(ob::PlannerTerminationCondition(scene.budget().search_over(0)));
  scene.budget().require_time();
  if (status != ob::PlannerStatus::EXACT_SOLUTION) throw scene.budget().nothing_found();
  auto& solution = *definition->getSolutionPath()->as<og::PathGeometric>();
  solution.interpolate();
  GroundPath path;
  for (const ob::State* state : solution.getStates()) path.push_back(point_of_pose(state));
  try {
    return make_route(scene, path, length_of_leg, kMaxPoints, "LegacyDubins");
  } catch (const Unflyable& reason) {
    throw AE_navigator::NoRoute(reason.what(), false);
  }
}

}  // namespace skein::navigation
