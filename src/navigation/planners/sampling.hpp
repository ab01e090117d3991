#pragma once

#include <ompl/base/Planner.h>

#include <functional>
#include <optional>
#include <vector>

#include "navigation/planners/route_making.hpp"

// What the planners on OMPL share. Only they include this: its headers are slow to compile.
namespace skein::navigation {

/// OMPL seeds its planners from one generator for the whole process; here each has its own.
template <class Planner>
class Seeded final : public Planner {
 public:
  Seeded(const ompl::base::SpaceInformationPtr& space, std::uint32_t seed) : Planner(space) {
    this->rng_.setLocalSeed(seed);
  }
};

/// One search over the map of a scene, whose legs are flown along the flight surface, clear of
/// zones and closed ground. The scene must outlive it.
class Sampling {
 public:
  Sampling(const PlanningScene& scene, std::uint32_t seed, Berth berth);

  const ompl::base::SpaceInformationPtr& space() const { return space_; }
  const ompl::base::ProblemDefinitionPtr& problem() const { return problem_; }

  /// Has legs cost what the scene says, instead of their length.
  void count_exposure() const;

  /// Runs the planner until it has a path or `ends` holds, asked at every step: the library's own
  /// time limits are polled late. Only a path that reaches the goal counts.
  std::optional<GroundPath> solve(ompl::base::Planner& planner,
                                  const std::function<bool()>& ends) const;

  /// Has `action` told of each path that is better than those before, with its cost, during
  /// solve(). What it throws is no answer and changes nothing: the search must come to its own end.
  void on_better_path(std::function<void(const GroundPath&, double)> action) const;

  /// The longest leg that a tree should grow by at once.
  double range_m() const;

 private:
  GroundPath start_to_goal(const std::vector<const ompl::base::State*>& states) const;

  const PlanningScene& scene_;
  ompl::base::SpaceInformationPtr space_;
  ompl::base::ProblemDefinitionPtr problem_;
};

}  // namespace skein::navigation
