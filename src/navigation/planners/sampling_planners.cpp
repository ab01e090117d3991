#include <ompl/geometric/planners/prm/PRMstar.h>
#include <ompl/geometric/planners/rrt/InformedRRTstar.h>
#include <ompl/geometric/planners/rrt/RRTConnect.h>
#include <ompl/geometric/planners/rrt/RRTstar.h>

#include <algorithm>
#include <limits>

#include "navigation/planners/planners.hpp"
#include "navigation/planners/route_making.hpp"
#include "navigation/planners/sampling.hpp"

namespace skein::navigation {
namespace {

namespace ob = ompl::base;
namespace og = ompl::geometric;

class RrtConnectPlanner final : public AE_navigator::IPlanner {
 public:
  RrtConnectPlanner(std::shared_ptr<TerrainProvider> terrains, PlannerOptions options)
      : terrains_(std::move(terrains)), options_(std::move(options)) {}

  AE_navigator::Route plan(const AE_navigator::Problem& problem) override {
    constexpr int kMaxPoints = 45;
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
        return make_route(scene, *path, length, kMaxPoints, "RRTConnect");
      } catch (const Unflyable& reason) {
        unflyable = reason.what();
      }
    }
    scene.budget().require_time();
    if (unflyable.empty()) throw scene.budget().nothing_found();
    throw AE_navigator::NoRoute("no path that was found can be flown: " + unflyable, false);
  }

 private:
  std::shared_ptr<TerrainProvider> terrains_;
  PlannerOptions options_;
};

/// How OMPL's planners that improve their path differ for us.
struct Improver {
  const char* name;
  ob::PlannerPtr (*make)(const Sampling& sampling, std::uint32_t seed);
};

template <class Planner>
ob::PlannerPtr make_tree(const Sampling& sampling, std::uint32_t seed) {
  auto planner = std::make_shared<Seeded<Planner>>(sampling.space(), seed);
  planner->setRange(sampling.range_m());
  return planner;
}

/// The library's own looks for a path on a second thread, where whatever is thrown ends the
/// process: for want of memory, or because two ends are joined by roads whose cost is no number.
/// Here the caller's thread looks, each time that the map has grown by a quarter.
class Roadmap final : public og::PRMstar {
 public:
  Roadmap(const ob::SpaceInformationPtr& space, std::uint32_t seed) : PRMstar(space) {
    rng_.setLocalSeed(seed);
  }

  ob::PlannerStatus solve(const ob::PlannerTerminationCondition& ends) override {
    checkValidity();
    while (const ob::State* start = pis_.nextStart()) {
      startM_.push_back(addMilestone(si_->cloneState(start)));
    }
    while (const ob::State* goal = pis_.nextGoal()) {
      goalM_.push_back(addMilestone(si_->cloneState(goal)));
    }
    if (startM_.empty()) return ob::PlannerStatus::INVALID_START;
    if (goalM_.empty()) return ob::PlannerStatus::INVALID_GOAL;
    ob::PathPtr best;
    while (!ends) {
      grow(ends);
      keep_better(best);
    }
    if (!best) return ob::PlannerStatus::TIMEOUT;
    pdef_->addSolutionPath(best, false, 0, getName());
    return ob::PlannerStatus::EXACT_SOLUTION;
  }

 private:
  void grow(const ob::PlannerTerminationCondition& ends) {
    constexpr unsigned long kLeast = 20;
    unsigned long left = std::max(kLeast, milestoneCount() / 4);
    constructRoadmap(ob::PlannerTerminationCondition([&] { return ends() || left-- == 0; }));
  }

  void keep_better(ob::PathPtr& best) {
    ob::PathPtr found;
    maybeConstructSolution(startM_, goalM_, found);
    if (!found) return;
    if (!best || opt_->isCostBetterThan(found->cost(opt_), best->cost(opt_))) best = found;
  }
};

ob::PlannerPtr make_roadmap(const Sampling& sampling, std::uint32_t seed) {
  return std::make_shared<Roadmap>(sampling.space(), seed);
}

class ImprovingPlanner final : public AE_navigator::IPlanner {
 public:
  ImprovingPlanner(const Improver& improver, std::shared_ptr<TerrainProvider> terrains,
                   PlannerOptions options)
      : improver_(improver), terrains_(std::move(terrains)), options_(std::move(options)) {}

  AE_navigator::Route plan(const AE_navigator::Problem& problem) override {
    return search(problem, [](const AE_navigator::Route&) {});
  }

  void improve(const AE_navigator::Problem& problem,
               StreamSink<AE_navigator::Route>& sink) override {
    // A route that the caller has no room for is overtaken by the next.
    sink.push(search(problem, [&](const AE_navigator::Route& route) { sink.try_push(route); }));
  }

 private:
  static constexpr int kMaxPoints = 100;
  // What a path must save to be worth a route of its own.
  static constexpr double kWorthwhile = 0.98;

  using Report = std::function<void(const AE_navigator::Route&)>;

  /// Where the last path comes to no route, in time or at all, the best before it is the answer.
  AE_navigator::Route search(const AE_navigator::Problem& problem, const Report& report) {
    const PlanningScene scene(*terrains_, problem, options_);
    const Sampling sampling(scene, options_.seed, Berth::ForTurns);
    sampling.count_exposure();
    const ob::PlannerPtr planner = improver_.make(sampling, options_.seed);
    planner->setProblemDefinition(sampling.problem());
    double tried = std::numeric_limits<double>::infinity();
    std::optional<AE_navigator::Route> best;
    sampling.on_better_path([&](const GroundPath& path, double cost) {
      if (cost > kWorthwhile * tried) return;
      tried = cost;
      best = route_of(scene, path);
      report(*best);
    });
    const Instant end = scene.budget().search_end(10);
    const auto path = sampling.solve(
        *planner, [&] { return scene.budget().stopped() || scene.budget().now() >= end; });
    try {
      scene.budget().require_time();
      if (!path) throw scene.budget().nothing_found();
      return route_of(scene, *path);
    } catch (const Unflyable& reason) {
      if (best) return std::move(*best);
      throw AE_navigator::NoRoute(std::string("the best path cannot be flown: ") + reason.what(),
                                  false);
    } catch (const AE_navigator::NoRoute&) {
      if (best) return std::move(*best);
      throw;
    }
  }

  AE_navigator::Route route_of(const PlanningScene& scene, const GroundPath& path) const {
    const auto cost = [&](const GroundPoint& a, const GroundPoint& b) { return scene.cost(a, b); };
    return make_route(scene, path, cost, kMaxPoints, improver_.name);
  }

  Improver improver_;
  std::shared_ptr<TerrainProvider> terrains_;
  PlannerOptions options_;
};

}  // namespace

std::unique_ptr<AE_navigator::IPlanner> make_rrt_connect(std::shared_ptr<TerrainProvider> terrains,
                                                         PlannerOptions options) {
  return std::make_unique<RrtConnectPlanner>(std::move(terrains), std::move(options));
}

std::unique_ptr<AE_navigator::IPlanner> make_rrt_star(std::shared_ptr<TerrainProvider> terrains,
                                                      PlannerOptions options) {
  return std::make_unique<ImprovingPlanner>(Improver{"RRTstar", make_tree<og::RRTstar>},
                                            std::move(terrains), std::move(options));
}

std::unique_ptr<AE_navigator::IPlanner> make_informed_rrt_star(
    std::shared_ptr<TerrainProvider> terrains, PlannerOptions options) {
  return std::make_unique<ImprovingPlanner>(
      Improver{"InformedRRTstar", make_tree<og::InformedRRTstar>}, std::move(terrains),
      std::move(options));
}

std::unique_ptr<AE_navigator::IPlanner> make_prm_star(std::shared_ptr<TerrainProvider> terrains,
                                                      PlannerOptions options) {
  return std::make_unique<ImprovingPlanner>(Improver{"PRMstar", make_roadmap}, std::move(terrains),
                                            std::move(options));
}

}  // namespace skein::navigation
