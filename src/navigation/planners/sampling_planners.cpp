#include <ompl/geometric/planners/prm/PRMstar.h>
#include <ompl/geometric/planners/rrt/InformedRRTstar.h>
#include <ompl/geometric/planners/rrt/RRTConnect.h>
#include <ompl/geometric/planners/rrt/RRTstar.h>

#include <algorithm>
#include <limits>

#include "navigation/planners/route_making.hpp"
#include "navigation/planners/sampling.hpp"

namespace skein::navigation {
namespace {

namespace ob = ompl::base;
namespace og = ompl::geometric;

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

using MakePlanner = ob::PlannerPtr (*)(const Sampling& sampling, std::uint32_t seed);

/// By one of OMPL's planners that improve their path. If the last path comes to no route, in
/// time or at all, the best before it is the answer.
AE_navigator::Route improve(const Search& search, const char* name, MakePlanner make) {
  constexpr int kMaxPoints = 100;
  // A path that saves less is not worth a route of its own.
  constexpr double kWorthwhile = 0.98;
  const PlanningScene scene(search);
  const auto route_of = [&](const GroundPath& path) {
    const auto cost = [&](const GroundPoint& a, const GroundPoint& b) { return scene.cost(a, b); };
    return make_route(scene, path, cost, kMaxPoints, name);
  };
  const Sampling sampling(scene, search.options.seed, Berth::ForTurns);
  sampling.count_exposure();
  const ob::PlannerPtr planner = make(sampling, search.options.seed);
  planner->setProblemDefinition(sampling.problem());
  double tried = std::numeric_limits<double>::infinity();
  std::optional<AE_navigator::Route> best;
  sampling.on_better_path([&](const GroundPath& path, double cost) {
    if (cost > kWorthwhile * tried) return;
    tried = cost;
    best = route_of(path);
    search.report(*best);
  });
  const auto path = sampling.solve(*planner, scene.budget().search_over(10));
  try {
    scene.budget().require_time();
    if (!path) throw scene.budget().nothing_found();
    return route_of(*path);
  } catch (const Unflyable& reason) {
    if (best) return std::move(*best);
    throw AE_navigator::NoRoute(std::string("the best path cannot be flown: ") + reason.what(),
                                false);
  } catch (const AE_navigator::NoRoute&) {
    if (best) return std::move(*best);
    throw;
  }
}

}  // namespace

AE_navigator::Route search_rrt_connect(const Search& search) {
  constexpr int kMaxPoints = 45;
  const PlanningScene scene(search);
  const auto over = scene.budget().search_over(0);
  std::string unflyable;
  // A path that cannot be flown is no answer; with other samples there may be one.
  for (std::uint32_t attempt = 0; !over(); ++attempt) {
    // Every other time as close to the zones as is allowed: a gap may be that narrow.
    const Berth berth = attempt % 2 == 0 ? Berth::ForTurns : Berth::Least;
    const std::uint32_t seed = search.options.seed + 2 * attempt;
    const Sampling sampling(scene, seed, berth);
    Seeded<og::RRTConnect> planner(sampling.space(), seed);
    planner.setRange(sampling.range_m());
    planner.setProblemDefinition(sampling.problem());
    const auto path = sampling.solve(planner, over);
    scene.budget().require_time();
    if (!path) break;
    try {
      return make_route(scene, *path, length_of_leg, kMaxPoints, "RRTConnect");
    } catch (const Unflyable& reason) {
      unflyable = reason.what();
    }
  }
  scene.budget().require_time();
  if (unflyable.empty()) throw scene.budget().nothing_found();
  throw AE_navigator::NoRoute("no path that was found can be flown: " + unflyable, false);
}

AE_navigator::Route search_rrt_star(const Search& search) {
  return improve(search, "RRTstar", make_tree<og::RRTstar>);
}

AE_navigator::Route search_informed_rrt_star(const Search& search) {
  return improve(search, "InformedRRTstar", make_tree<og::InformedRRTstar>);
}

AE_navigator::Route search_prm_star(const Search& search) {
  return improve(search, "PRMstar", make_roadmap);
}

}  // namespace skein::navigation
