#include <algorithm>
#include <cstdint>
#include <numeric>
#include <unordered_map>

#include "planning/collection_problem.hpp"

namespace reconnaissance {
namespace {

constexpr double FlightCost::*kParts[]{&FlightCost::seconds, &FlightCost::fuel_kg,
                                       &FlightCost::hazard};

class Search {
 public:
  Search(const CollectionProblem& problem, const std::function<bool()>& may_go_on)
      : problem_(problem), may_go_on_(may_go_on), least_(lower_bounds(problem)) {
    found_.plan = heuristic_plan(problem);
    for (std::size_t task = 0; task < problem.tasks(); ++task) {
      least_to_add_.push_back(least_to_add(task));
    }
  }

  SearchedPlan run() {
    found_.proven = true;
    if (found_.plan.feasible || problem_.allows(least(0, problem_.landing()))) visit(0, 0, 0, {});
    return found_;
  }

 private:
  using Tasks = std::uint64_t;

  /// The least of each part on any way from node to node; parts may be those of different ways
  /// (Floyd and Warshall 1962). Legs need not keep the triangle inequality.
  static std::vector<FlightCost> lower_bounds(const CollectionProblem& problem) {
    const std::size_t nodes = problem.nodes();
    std::vector<FlightCost> least;
    for (std::size_t i = 0; i < nodes; ++i) {
      for (std::size_t j = 0; j < nodes; ++j) least.push_back(problem.step(i, j));
    }
    for (std::size_t k = 0; k < nodes; ++k) {
      for (std::size_t i = 0; i < nodes; ++i) {
        for (std::size_t j = 0; j < nodes; ++j) {
          for (const auto part : kParts) {
            least[i * nodes + j].*part =
                std::min(least[i * nodes + j].*part,
                         least[i * nodes + k].*part + least[k * nodes + j].*part);
          }
        }
      }
    }
    return least;
  }

  /// Each task is entered by one step.
  FlightCost least_to_add(std::size_t task) const {
    constexpr double kInfinity = std::numeric_limits<double>::infinity();
    FlightCost least{kInfinity, kInfinity, kInfinity};
    for (std::size_t from = 0; from < problem_.landing(); ++from) {
      if (from != 0 && problem_.task_of(from) == task) continue;
      for (std::size_t to = problem_.first_node(task); to < problem_.end_node(task); ++to) {
        for (const auto part : kParts) {
          least.*part = std::min(least.*part, problem_.step(from, to).*part);
        }
      }
    }
    return least;
  }

  const FlightCost& least(std::size_t from, std::size_t to) const {
    return least_[from * problem_.nodes() + to];
  }

  /// What else can be worth, at most.
  double bound(std::size_t node, Tasks done, const FlightCost& cost) {
    reachable_.clear();
    for (std::size_t task = 0; task < problem_.tasks(); ++task) {
      if (done >> task & 1) continue;
      for (std::size_t pass = problem_.first_node(task); pass < problem_.end_node(task); ++pass) {
        if (problem_.allows(cost + least(node, pass) + least(pass, problem_.landing()))) {
          reachable_.push_back(task);
          break;
        }
      }
    }
    double most =
        std::accumulate(reachable_.begin(), reachable_.end(), 0.0,
                        [&](double sum, std::size_t task) { return sum + problem_.value(task); });
    for (const auto part : kParts) most = std::min(most, knapsack(part, cost));
    return most;
  }

  double knapsack(double FlightCost::*part, const FlightCost& cost) {
    double room = std::max(problem_.limits().*part - cost.*part, 0.0);
    std::sort(reachable_.begin(), reachable_.end(), [&](std::size_t a, std::size_t b) {
      return problem_.value(a) * (least_to_add_[b].*part) >
             problem_.value(b) * (least_to_add_[a].*part);
    });
    double value = 0;
    for (const std::size_t task : reachable_) {
      const double needed = least_to_add_[task].*part;
      if (needed > room) return value + problem_.value(task) * room / needed;
      room -= needed;
      value += problem_.value(task);
    }
    return value;
  }

  bool was_seen_cheaper(std::size_t node, Tasks done, const FlightCost& cost) {
    std::vector<FlightCost>& seen = seen_[done * problem_.nodes() + node];
    for (const FlightCost& one : seen) {
      if (covers(one, cost)) return true;
    }
    std::erase_if(seen, [&](const FlightCost& one) { return covers(cost, one); });
    seen.push_back(cost);
    return false;
  }

  void visit(std::size_t node, Tasks done, double value, const FlightCost& cost) {
    if (!found_.proven || !(found_.proven = may_go_on_())) return;
    if (was_seen_cheaper(node, done, cost)) return;
    const FlightCost total = cost + problem_.step(node, problem_.landing());
    const CollectionTour plan{way_, value, total, problem_.allows(total)};
    if (plan.feasible && is_better(plan, found_.plan)) found_.plan = plan;

    const double most = value + bound(node, done, cost);
    const double same = 1e-9 * most;
    if (most < found_.plan.value - same) return;
    const double soonest_s = cost.seconds + least(node, problem_.landing()).seconds;
    if (most <= found_.plan.value + same && soonest_s >= found_.plan.cost.seconds) return;

    std::vector<std::size_t> next;
    for (std::size_t to = 1; to < problem_.landing(); ++to) {
      if (done >> problem_.task_of(to) & 1) continue;
      const FlightCost reached = cost + problem_.step(node, to);
      if (problem_.allows(reached + least(to, problem_.landing()))) next.push_back(to);
    }
    std::stable_sort(next.begin(), next.end(), [&](std::size_t a, std::size_t b) {
      return problem_.step(node, a).seconds < problem_.step(node, b).seconds;
    });
    for (const std::size_t to : next) {
      const std::size_t task = problem_.task_of(to);
      way_.push_back({task, to - problem_.first_node(task)});
      visit(to, done | Tasks{1} << task, value + problem_.value(task),
            cost + problem_.step(node, to));
      way_.pop_back();
    }
  }

  const CollectionProblem& problem_;
  const std::function<bool()>& may_go_on_;
  std::vector<FlightCost> least_;
  std::vector<FlightCost> least_to_add_;
  std::vector<std::size_t> reachable_;
  std::unordered_map<std::uint64_t, std::vector<FlightCost>> seen_;
  std::vector<Collection> way_;
  SearchedPlan found_;
};

}  // namespace

SearchedPlan branch_and_bound_plan(const CollectionProblem& problem,
                                   const std::function<bool()>& may_go_on) {
  return Search(problem, may_go_on).run();
}

}  // namespace reconnaissance
