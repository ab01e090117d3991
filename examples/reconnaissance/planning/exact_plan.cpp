#include <algorithm>
#include <bit>
#include <cstdint>
#include <stdexcept>

#include "planning/collection_problem.hpp"

namespace reconnaissance {
namespace {

using Tasks = std::uint32_t;  // a bit for each

/// A way to collect a set of tasks that ends with a pass.
struct Way {
  FlightCost cost;
  std::size_t before_node;
  std::size_t before_way;
};

/// Keeps ways of which none covers another.
void add(std::vector<Way>& ways, const Way& way) {
  for (const Way& one : ways) {
    if (covers(one.cost, way.cost)) return;
  }
  // No way refers to those of its own set, so that they can still be removed.
  std::erase_if(ways, [&](const Way& one) { return covers(way.cost, one.cost); });
  ways.push_back(way);
}

}  // namespace

CollectionTour exact_plan(const CollectionProblem& problem) {
  if (problem.tasks() > 9) throw std::invalid_argument("exact_plan takes at most 9 tasks");
  const std::size_t nodes = problem.nodes();
  const Tasks all = (Tasks{1} << problem.tasks()) - 1;
  std::vector<std::vector<Way>> ways((all + std::size_t{1}) * nodes);
  const auto at = [&](Tasks done, std::size_t node) -> std::vector<Way>& {
    return ways[done * nodes + node];
  };
  at(0, 0).push_back({});

  CollectionTour best;
  Tasks best_done = 0;
  Way best_last{};
  for (Tasks done = 0; done <= all; ++done) {
    double value = 0;
    for (std::size_t task = 0; task < problem.tasks(); ++task) {
      if (done >> task & 1) value += problem.value(task);
    }
    for (std::size_t node = 0; node < nodes; ++node) {
      const std::vector<Way>& here = at(done, node);
      for (std::size_t way = 0; way < here.size(); ++way) {
        const FlightCost total = here[way].cost + problem.step(node, problem.landing());
        CollectionTour plan{{}, value, total, problem.allows(total)};
        if (plan.feasible && is_better(plan, best)) {
          best = plan;
          best_done = done;
          best_last = {total, node, way};
        }
        for (std::size_t task = 0; task < problem.tasks(); ++task) {
          if (done >> task & 1) continue;
          for (std::size_t next = problem.first_node(task); next < problem.end_node(task); ++next) {
            const FlightCost cost = here[way].cost + problem.step(node, next);
            if (problem.allows(cost)) add(at(done | Tasks{1} << task, next), {cost, node, way});
          }
        }
      }
    }
  }
  Tasks done = best_done;
  for (Way last = best_last; last.before_node != 0;) {
    const std::size_t node = last.before_node;
    const std::size_t task = problem.task_of(node);
    best.collections.push_back({task, node - problem.first_node(task)});
    last = at(done, node)[last.before_way];
    done &= ~(Tasks{1} << task);
  }
  std::reverse(best.collections.begin(), best.collections.end());
  return best;
}

}  // namespace reconnaissance
