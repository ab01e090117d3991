#include "navigation/planners/sampling.hpp"

#include <ompl/base/MotionValidator.h>
#include <ompl/base/OptimizationObjective.h>
#include <ompl/base/ScopedState.h>
#include <ompl/base/goals/GoalRegion.h>
#include <ompl/base/spaces/RealVectorStateSpace.h>
#include <ompl/geometric/PathGeometric.h>
#include <ompl/util/Console.h>

#include <mutex>

namespace skein::navigation {
namespace {

namespace ob = ompl::base;

GroundPoint point_of(const ob::State* state) {
  const auto* values = state->as<ob::RealVectorStateSpace::StateType>()->values;
  return {values[0], values[1]};
}

/// A leg is flown along the flight surface, clear of zones and closed ground.
class LegValidator final : public ob::MotionValidator {
 public:
  LegValidator(const ob::SpaceInformationPtr& space, const PlanningScene& scene, Berth berth)
      : MotionValidator(space), scene_(scene), berth_(berth) {}

  bool checkMotion(const ob::State* from, const ob::State* to) const override {
    return scene_.free(point_of(from), point_of(to), berth_);
  }

  bool checkMotion(const ob::State* from, const ob::State* to,
                   std::pair<ob::State*, double>& last_valid) const override {
    if (checkMotion(from, to)) return true;
    if (last_valid.first) si_->copyState(last_valid.first, from);
    last_valid.second = 0;
    return false;
  }

 private:
  const PlanningScene& scene_;
  Berth berth_;
};

class RiskObjective final : public ob::OptimizationObjective {
 public:
  RiskObjective(const ob::SpaceInformationPtr& space, const PlanningScene& scene)
      : OptimizationObjective(space), scene_(scene) {
    setCostToGoHeuristic(ob::goalRegionCostToGo);
  }

  ob::Cost stateCost(const ob::State*) const override { return identityCost(); }
  ob::Cost motionCost(const ob::State* from, const ob::State* to) const override {
    return ob::Cost(scene_.cost(point_of(from), point_of(to)));
  }
  ob::Cost motionCostHeuristic(const ob::State* from, const ob::State* to) const override {
    return ob::Cost(si_->distance(from, to));
  }

 private:
  const PlanningScene& scene_;
};

class SeededSampler final : public ob::RealVectorStateSampler {
 public:
  SeededSampler(const ob::StateSpace* space, std::uint32_t seed) : RealVectorStateSampler(space) {
    rng_.setLocalSeed(seed);
  }
};

/// The map, whose samplers are seeded, those that informed planners ask for too.
class Plane final : public ob::RealVectorStateSpace {
 public:
  Plane(const Terrain& terrain, std::uint32_t seed) : RealVectorStateSpace(2), seed_(seed) {
    ob::RealVectorBounds bounds(2);
    bounds.setLow(0);
    bounds.setHigh(0, terrain.north_extent_m());
    bounds.setHigh(1, terrain.east_extent_m());
    setBounds(bounds);
  }
  ob::StateSamplerPtr allocDefaultStateSampler() const override {
    return std::make_shared<SeededSampler>(this, seed_);
  }

 private:
  std::uint32_t seed_;
};

ob::ScopedState<> state_at(const ob::SpaceInformationPtr& space, const Position& position) {
  ob::ScopedState<> state(space);
  state[0] = position.north_m;
  state[1] = position.east_m;
  return state;
}

}  // namespace

Sampling::Sampling(const PlanningScene& scene, std::uint32_t seed, Berth berth) : scene_(scene) {
  static std::once_flag quiet;  // The library writes to standard output otherwise.
  std::call_once(quiet, [] { ompl::msg::noOutputHandler(); });
  space_ =
      std::make_shared<ob::SpaceInformation>(std::make_shared<Plane>(scene.terrain(), seed + 1));
  space_->setStateValidityChecker(
      [&scene, berth](const ob::State* state) { return scene.free(point_of(state), berth); });
  space_->setMotionValidator(std::make_shared<LegValidator>(space_, scene, berth));
  space_->setup();
  problem_ = std::make_shared<ob::ProblemDefinition>(space_);
  problem_->setStartAndGoalStates(state_at(space_, scene.problem().start),
                                  state_at(space_, scene.problem().goal));
}

void Sampling::count_exposure() const {
  problem_->setOptimizationObjective(std::make_shared<RiskObjective>(space_, scene_));
}

std::optional<GroundPath> Sampling::solve(ob::Planner& planner,
                                          const std::function<bool()>& ends) const {
  if (planner.solve(ob::PlannerTerminationCondition(ends)) != ob::PlannerStatus::EXACT_SOLUTION)
    return std::nullopt;
  GroundPath path;
  auto& solution = *problem_->getSolutionPath()->as<ompl::geometric::PathGeometric>();
  for (const ob::State* state : solution.getStates()) path.push_back(point_of(state));
  return path;
}

/// Planners differ in whether they begin with the goal and whether they tell of both ends.
GroundPath Sampling::start_to_goal(const std::vector<const ob::State*>& states) const {
  const GroundPoint start = on_map(scene_.problem().start);
  const GroundPoint goal = on_map(scene_.problem().goal);
  GroundPath between;
  for (const ob::State* state : states) {
    const GroundPoint point = point_of(state);
    if (distance_m(point, start) > 0 && distance_m(point, goal) > 0) between.push_back(point);
  }
  if (!between.empty() &&
      distance_m(between.front(), start) + distance_m(between.back(), goal) >
          distance_m(between.back(), start) + distance_m(between.front(), goal)) {
    std::reverse(between.begin(), between.end());
  }
  between.insert(between.begin(), start);
  between.push_back(goal);
  return between;
}

void Sampling::on_better_path(std::function<void(const GroundPath&, double)> action) const {
  problem_->setIntermediateSolutionCallback(
      [this, action = std::move(action)](
          const ob::Planner*, const std::vector<const ob::State*>& states, ob::Cost cost) {
        try {
          action(start_to_goal(states), cost.value());
        } catch (const std::exception&) {
        }
      });
}

double Sampling::range_m() const {
  return 0.12 * std::max(scene_.terrain().north_extent_m(), scene_.terrain().east_extent_m());
}

}  // namespace skein::navigation
