// The only source that sees OMPL.

#include <ompl/base/MotionValidator.h>
#include <ompl/base/OptimizationObjective.h>
#include <ompl/base/ScopedState.h>
#include <ompl/base/spaces/RealVectorStateSpace.h>
#include <ompl/geometric/PathGeometric.h>
#include <ompl/geometric/planners/rrt/RRTConnect.h>
#include <ompl/geometric/planners/rrt/RRTstar.h>
#include <ompl/util/Console.h>

#include <limits>
#include <mutex>

#include "route_making.hpp"
#include "skein/navigation/planners.hpp"

namespace skein::navigation {
namespace {

namespace ob = ompl::base;
namespace og = ompl::geometric;

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
      : OptimizationObjective(space), scene_(scene) {}

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

/// OMPL seeds its planners from one generator for the whole process; here each has its own.
template <class Planner>
class Seeded final : public Planner {
 public:
  Seeded(const ob::SpaceInformationPtr& space, std::uint32_t seed) : Planner(space) {
    this->rng_.setLocalSeed(seed);
  }
};

/// One search over the map of a scene.
class Sampling {
 public:
  Sampling(const PlanningScene& scene, std::uint32_t seed, Berth berth) : scene_(scene) {
    auto plane = std::make_shared<ob::RealVectorStateSpace>(2);
    ob::RealVectorBounds bounds(2);
    bounds.setLow(0);
    bounds.setHigh(0, scene.terrain().north_extent_m());
    bounds.setHigh(1, scene.terrain().east_extent_m());
    plane->setBounds(bounds);
    plane->setStateSamplerAllocator([seed](const ob::StateSpace* space) {
      return std::make_shared<SeededSampler>(space, seed + 1);
    });
    space_ = std::make_shared<ob::SpaceInformation>(plane);
    space_->setStateValidityChecker(
        [&scene, berth](const ob::State* state) { return scene.free(point_of(state), berth); });
    space_->setMotionValidator(std::make_shared<LegValidator>(space_, scene, berth));
    space_->setup();
    problem_ = std::make_shared<ob::ProblemDefinition>(space_);
    problem_->setStartAndGoalStates(state_at(scene.problem().start),
                                    state_at(scene.problem().goal));
  }

  const ob::SpaceInformationPtr& space() const { return space_; }
  const ob::ProblemDefinitionPtr& problem() const { return problem_; }

  /// Runs the planner until it has a path or `ends` holds, asked at every step: the library's own
  /// time limits are polled late. Only a path that reaches the goal counts.
  std::optional<GroundPath> solve(ob::Planner& planner, const std::function<bool()>& ends) const {
    const ob::PlannerStatus status = planner.solve(ob::PlannerTerminationCondition(ends));
    if (status != ob::PlannerStatus::EXACT_SOLUTION) return std::nullopt;
    GroundPath path;
    for (const ob::State* state :
         problem_->getSolutionPath()->as<og::PathGeometric>()->getStates()) {
      path.push_back(point_of(state));
    }
    return path;
  }

  /// Has `action` told of each path that is better than those before, with its cost, during
  /// solve(). What it throws is no answer and changes nothing: the search must come to its own end.
  void on_better_path(std::function<void(const GroundPath&, double)> action) const {
    problem_->setIntermediateSolutionCallback(
        [this, action = std::move(action)](
            const ob::Planner*, const std::vector<const ob::State*>& states, ob::Cost cost) {
          // From behind, and without both ends.
          GroundPath path{on_map(scene_.problem().start)};
          for (auto state = states.rbegin(); state != states.rend(); ++state)
            path.push_back(point_of(*state));
          path.push_back(on_map(scene_.problem().goal));
          try {
            action(path, cost.value());
          } catch (const std::exception&) {
          }
        });
  }

  double range_m() const {
    return 0.12 * std::max(scene_.terrain().north_extent_m(), scene_.terrain().east_extent_m());
  }

 private:
  ob::ScopedState<> state_at(const Position& position) const {
    ob::ScopedState<> state(space_);
    state[0] = position.north_m;
    state[1] = position.east_m;
    return state;
  }

  const PlanningScene& scene_;
  ob::SpaceInformationPtr space_;
  ob::ProblemDefinitionPtr problem_;
};

class SamplingPlanner : public AE_navigator::IPlanner {
 public:
  SamplingPlanner(std::shared_ptr<TerrainProvider> terrains, PlannerOptions options)
      : terrains_(std::move(terrains)), options_(std::move(options)) {
    static std::once_flag quiet;  // The library writes to standard output otherwise.
    std::call_once(quiet, [] { ompl::msg::noOutputHandler(); });
  }

 protected:
  std::shared_ptr<TerrainProvider> terrains_;
  PlannerOptions options_;
};

class RrtConnectPlanner final : public SamplingPlanner {
 public:
  using SamplingPlanner::SamplingPlanner;

  AE_navigator::Route plan(const AE_navigator::Problem& problem) override {
    constexpr int kMostPoints = 45;
    const PlanningScene scene(*terrains_, problem, options_);
    const LegCost length = [](const GroundPoint& a, const GroundPoint& b) {
      return distance_m(a, b);
    };
    const Instant end = scene.budget().search_end(0);
    std::string unflyable;
    // A path that cannot be flown is no answer; with other samples there may be one.
    for (std::uint32_t attempt = 0; scene.budget().now() < end; ++attempt) {
      // Every other time as close to the zones as is allowed: a gap may be that narrow.
      const Berth berth = attempt % 2 == 0 ? Berth::ForTurns : Berth::Least;
      const Sampling sampling(scene, options_.seed + 2 * attempt, berth);
      Seeded<og::RRTConnect> planner(sampling.space(), options_.seed + 2 * attempt);
      planner.setRange(sampling.range_m());
      planner.setProblemDefinition(sampling.problem());
      const auto path = sampling.solve(
          planner, [&] { return scene.budget().stopped() || scene.budget().now() >= end; });
      scene.budget().require_time();
      if (!path) break;
      try {
        return make_route(scene, *path, length, kMostPoints, "RRTConnect");
      } catch (const Unflyable& reason) {
        unflyable = reason.what();
      }
    }
    scene.budget().require_time();
    if (unflyable.empty()) throw scene.budget().nothing_found();
    throw AE_navigator::NoRoute("no path that was found can be flown: " + unflyable, false);
  }

  void improve(const AE_navigator::Problem& problem,
               StreamSink<AE_navigator::Route>& sink) override {
    sink.push(plan(problem));
  }
};

class RrtStarPlanner final : public SamplingPlanner {
 public:
  using SamplingPlanner::SamplingPlanner;

  AE_navigator::Route plan(const AE_navigator::Problem& problem) override {
    return search(problem, nullptr);
  }

  void improve(const AE_navigator::Problem& problem,
               StreamSink<AE_navigator::Route>& sink) override {
    bool any = false;
    std::optional<AE_navigator::Route> best;
    try {
      best = search(problem, [&](const AE_navigator::Route& route) {
        // A route that the caller has no room for is overtaken by the next.
        if (sink.try_push(route)) any = true;
      });
    } catch (const AE_navigator::NoRoute&) {
      if (!any) throw;
    }
    if (best) sink.push(std::move(*best));
  }

 private:
  static constexpr int kMostPoints = 100;
  // What a path must save to be worth a route of its own.
  static constexpr double kWorthwhile = 0.98;

  using Report = std::function<void(const AE_navigator::Route&)>;

  AE_navigator::Route search(const AE_navigator::Problem& problem, const Report& report) {
    const PlanningScene scene(*terrains_, problem, options_);
    const Sampling sampling(scene, options_.seed, Berth::ForTurns);
    sampling.problem()->setOptimizationObjective(
        std::make_shared<RiskObjective>(sampling.space(), scene));
    Seeded<og::RRTstar> planner(sampling.space(), options_.seed);
    planner.setRange(sampling.range_m());
    planner.setProblemDefinition(sampling.problem());
    scene.cost(on_map(problem.start), on_map(problem.goal));
    double reported = std::numeric_limits<double>::infinity();
    if (report) {
      sampling.on_better_path([&](const GroundPath& path, double cost) {
        if (cost > kWorthwhile * reported) return;
        reported = cost;
        report(route_of(scene, path));
      });
    }
    const Instant end = scene.budget().search_end(10);
    const auto path = sampling.solve(
        planner, [&] { return scene.budget().stopped() || scene.budget().now() >= end; });
    scene.budget().require_time();
    if (!path) throw scene.budget().nothing_found();
    try {
      return route_of(scene, *path);
    } catch (const Unflyable& reason) {
      throw AE_navigator::NoRoute(std::string("the best path cannot be flown: ") + reason.what(),
                                  false);
    }
  }

  static AE_navigator::Route route_of(const PlanningScene& scene, const GroundPath& path) {
    const auto cost = [&](const GroundPoint& a, const GroundPoint& b) { return scene.cost(a, b); };
    return make_route(scene, path, cost, kMostPoints, "RRTstar");
  }
};

}  // namespace

std::unique_ptr<AE_navigator::IPlanner> make_rrt_connect(std::shared_ptr<TerrainProvider> terrains,
                                                         PlannerOptions options) {
  return std::make_unique<RrtConnectPlanner>(std::move(terrains), std::move(options));
}

std::unique_ptr<AE_navigator::IPlanner> make_rrt_star(std::shared_ptr<TerrainProvider> terrains,
                                                      PlannerOptions options) {
  return std::make_unique<RrtStarPlanner>(std::move(terrains), std::move(options));
}

}  // namespace skein::navigation
