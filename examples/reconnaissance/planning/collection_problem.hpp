#pragma once

#include <functional>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "planning/dubins_length.hpp"

namespace reconnaissance {

/// What a part of a flight takes. Hazard is ∫ λ dt of the threats passed: the probability to
/// survive it is exp(−hazard).
struct FlightCost {
  double seconds = 0;
  double fuel_kg = 0;
  double hazard = 0;

  FlightCost& operator+=(const FlightCost& other);
  friend FlightCost operator+(FlightCost a, const FlightCost& b) { return a += b; }
};

/// No part is greater.
bool covers(const FlightCost& a, const FlightCost& b);

struct FlightLimits {
  double endurance_s = std::numeric_limits<double>::infinity();
  double fuel_kg = std::numeric_limits<double>::infinity();
  double least_survival = 0;

  FlightCost most() const;
};

/// Why an estimate is not within the limits, in words that follow its subject ("survives with …");
/// nullopt if it is. What it decides is not flown, or no further.
std::optional<std::string> excess(const FlightCost& estimate, const FlightLimits& limits);

/// One way to collect an element of interest: where and on which course its collection begins and
/// ends, and what it takes.
struct CollectionPass {
  RoutePose begin;
  RoutePose end;
  FlightCost cost;
};

struct CollectionTask {
  double value = 0;  ///< Of having it; positive.
  std::vector<CollectionPass> passes;
};

/// Which elements of interest to collect, in which order and by which passes, between a start and a
/// landing: those that are worth most together, of these the ones that take the least time, within
/// the limits (an orienteering problem, Golden, Levy and Vohra 1987, with three limits).
class CollectionProblem {
 public:
  /// What it takes to fly from pose to pose; finite and not negative.
  using Leg = std::function<FlightCost(const RoutePose& from, const RoutePose& to)>;

  /// At most 48 tasks. Throws std::invalid_argument for more, for a task without a pass or value,
  /// and for a leg whose cost is negative or not finite.
  CollectionProblem(const RoutePose& start, const RoutePose& landing,
                    std::vector<CollectionTask> tasks, const Leg& leg, const FlightLimits& limits);

  // Nodes: 0 is the start, then the passes of all tasks in turn, last the landing.
  std::size_t tasks() const { return tasks_.size(); }
  double value(std::size_t task) const { return tasks_[task].value; }
  std::size_t nodes() const { return task_of_.size() + 2; }
  std::size_t landing() const { return nodes() - 1; }
  std::size_t first_node(std::size_t task) const { return first_node_[task]; }
  std::size_t end_node(std::size_t task) const {
    return first_node_[task] + tasks_[task].passes.size();
  }
  std::size_t task_of(std::size_t node) const { return task_of_[node - 1]; }

  /// From the end of a pass to the end of the next, so that it contains the next one's cost.
  const FlightCost& step(std::size_t from, std::size_t to) const {
    return steps_[from * nodes() + to];
  }
  const FlightCost& limits() const { return limits_; }
  bool allows(const FlightCost& cost) const { return covers(cost, limits_); }

 private:
  std::vector<CollectionTask> tasks_;
  std::vector<std::size_t> first_node_;
  std::vector<std::size_t> task_of_;
  std::vector<FlightCost> steps_;
  FlightCost limits_;
};

struct Collection {
  std::size_t task = 0;
  std::size_t pass = 0;  ///< Of that task.
  bool operator==(const Collection&) const = default;
};

struct CollectionTour {
  std::vector<Collection> collections;  ///< In order.
  double value = 0;
  FlightCost cost;        ///< To the landing.
  bool feasible = false;  ///< False: not even the way from start to landing is within the limits.
};

/// More value, or the same (to 1e-9 of it) in less time.
bool is_better(const CollectionTour& a, const CollectionTour& b);

/// The best of all plans, in some 20 ms for 9 tasks: by dynamic programming over subsets of tasks
/// (Held and Karp 1962) with all costs of which none covers another. At most 9 tasks; throws
/// std::invalid_argument for more.
CollectionTour exact_plan(const CollectionProblem& problem);

/// A good plan, in some 0.1 s for 12 tasks and 1 s for 20: all tasks by nearest neighbour, improved
/// by 2-opt and by moving single tasks; while a limit is broken, the task with the least value for
/// what it takes is dropped; then what fits is taken in again, also in exchange for one that is
/// worth less. The same from no task on, and with other weights of the limits; the best of these.
/// Never better than exact_plan().
CollectionTour heuristic_plan(const CollectionProblem& problem);

struct SearchedPlan {
  CollectionTour plan;
  bool proven = false;  ///< No plan is better.
};

/// The best plan if there is time enough to find it, else the best found: never worse than
/// heuristic_plan(). Branch and bound, depth first; a partial plan is cut off if what can still be
/// collected within each limit (a fractional knapsack of lower bounds) is not worth more, or if one
/// was seen that has collected the same at no greater cost. Asks `may_go_on` before each step.
SearchedPlan branch_and_bound_plan(const CollectionProblem& problem,
                                   const std::function<bool()>& may_go_on);

}  // namespace reconnaissance
