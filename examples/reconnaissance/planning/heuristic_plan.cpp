#include <algorithm>
#include <cmath>
#include <cstdint>

#include "planning/collection_problem.hpp"

namespace reconnaissance {
namespace {

using Order = std::vector<std::size_t>;  // tasks

/// Costs as one number: a weighted sum of the shares of the limits, and the time in case none is
/// limited.
class Strain {
 public:
  Strain(const CollectionProblem& problem, const FlightCost& weights) : problem(problem) {
    const FlightCost& most = problem.limits();
    per_second_ = 1e-9 + weights.seconds / std::max(most.seconds, kLeastLimit);
    per_kg_ = weights.fuel_kg / std::max(most.fuel_kg, kLeastLimit);
    per_hazard_ = weights.hazard / std::max(most.hazard, kLeastLimit);
  }

  double operator()(const FlightCost& cost) const {
    return per_second_ * cost.seconds + per_kg_ * cost.fuel_kg + per_hazard_ * cost.hazard;
  }

  const CollectionProblem& problem;

 private:
  static constexpr double kLeastLimit = 1e-12;
  double per_second_, per_kg_, per_hazard_;
};

/// The passes with the least strain for an order, layer by layer.
CollectionTour with_best_passes(const Strain& strain, const Order& order) {
  const CollectionProblem& problem = strain.problem;
  struct Reached {
    double strain;
    FlightCost cost;
    std::size_t node;
    std::size_t before;  // in the layer before
  };
  std::vector<std::vector<Reached>> layers{{{0, {}, 0, 0}}};
  const auto reach = [&](std::size_t node) {
    Reached best{std::numeric_limits<double>::infinity(), {}, node, 0};
    const std::vector<Reached>& before = layers.back();
    for (std::size_t i = 0; i < before.size(); ++i) {
      const FlightCost& step = problem.step(before[i].node, node);
      const double sum = before[i].strain + strain(step);
      if (sum < best.strain) best = {sum, before[i].cost + step, node, i};
    }
    return best;
  };
  for (const std::size_t task : order) {
    std::vector<Reached> layer;
    for (std::size_t node = problem.first_node(task); node < problem.end_node(task); ++node) {
      layer.push_back(reach(node));
    }
    layers.push_back(std::move(layer));
  }
  const Reached landed = reach(problem.landing());
  CollectionTour plan;
  plan.cost = landed.cost;
  plan.feasible = problem.allows(plan.cost);
  std::size_t last = landed.before;
  for (std::size_t i = order.size(); i > 0; --i) {
    const Reached& reached = layers[i][last];
    plan.collections.push_back({order[i - 1], reached.node - problem.first_node(order[i - 1])});
    plan.value += problem.value(order[i - 1]);
    last = reached.before;
  }
  std::reverse(plan.collections.begin(), plan.collections.end());
  return plan;
}

double strain_of(const Strain& strain, const Order& order) {
  return strain(with_best_passes(strain, order).cost);
}

Order nearest_neighbours(const CollectionProblem& problem) {
  Order order;
  std::vector<bool> taken(problem.tasks());
  std::size_t node = 0;
  while (order.size() < problem.tasks()) {
    std::size_t nearest = 0;
    double least = std::numeric_limits<double>::infinity();
    for (std::size_t next = 1; next < problem.landing(); ++next) {
      const double seconds = problem.step(node, next).seconds;
      if (taken[problem.task_of(next)] || seconds >= least) continue;
      least = seconds;
      nearest = next;
    }
    node = nearest;
    taken[problem.task_of(node)] = true;
    order.push_back(problem.task_of(node));
  }
  return order;
}

Order::iterator at(Order& order, std::size_t position) {
  return order.begin() + static_cast<std::ptrdiff_t>(position);
}

/// 2-opt (Croes 1958) and moves of single tasks, until none helps.
void improve(const Strain& strain, Order& order) {
  double least = strain_of(strain, order);
  const auto attempt = [&](const Order& changed) {
    const double sum = strain_of(strain, changed);
    if (sum >= least - 1e-12) return false;
    least = sum;
    order = changed;
    return true;
  };
  for (bool better = true; better;) {
    better = false;
    for (std::size_t i = 0; i < order.size(); ++i) {
      for (std::size_t j = i + 1; j < order.size(); ++j) {
        Order turned = order;
        std::reverse(at(turned, i), at(turned, j + 1));
        better = attempt(turned) || better;
        Order later = order;
        std::rotate(at(later, i), at(later, i + 1), at(later, j + 1));
        better = attempt(later) || better;
        Order earlier = order;
        std::rotate(at(earlier, i), at(earlier, j), at(earlier, j + 1));
        better = attempt(earlier) || better;
      }
    }
  }
}

Order without(const Order& order, std::size_t position) {
  Order shorter = order;
  shorter.erase(at(shorter, position));
  return shorter;
}

/// With the task where it strains least.
Order with(const Strain& strain, const Order& order, std::size_t task) {
  Order best;
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t position = 0; position <= order.size(); ++position) {
    Order longer = order;
    longer.insert(at(longer, position), task);
    const double sum = strain_of(strain, longer);
    if (sum >= least) continue;
    least = sum;
    best = longer;
  }
  return best;
}

void drop_one(const Strain& strain, Order& order) {
  const double whole = strain_of(strain, order);
  std::size_t dropped = 0;
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < order.size(); ++i) {
    const double saved = std::max(whole - strain_of(strain, without(order, i)), 1e-12);
    const double worth = strain.problem.value(order[i]) / saved;
    if (worth >= least) continue;
    least = worth;
    dropped = i;
  }
  order = without(order, dropped);
  improve(strain, order);
}

/// Takes in what fits, or fits in the place of one that is worth less.
bool take_in(const Strain& strain, Order& order) {
  const double value = with_best_passes(strain, order).value;
  for (std::size_t task = 0; task < strain.problem.tasks(); ++task) {
    if (std::find(order.begin(), order.end(), task) != order.end()) continue;
    for (std::size_t i = 0; i <= order.size(); ++i) {
      // The last turn exchanges nothing.
      Order changed = with(strain, i < order.size() ? without(order, i) : order, task);
      CollectionTour plan = with_best_passes(strain, changed);
      if (plan.value <= value) continue;
      if (!plan.feasible && i == order.size()) {
        improve(strain, changed);
        plan = with_best_passes(strain, changed);
      }
      if (!plan.feasible) continue;
      order = changed;
      return true;
    }
  }
  return false;
}

}  // namespace

CollectionTour heuristic_plan(const CollectionProblem& problem) {
  CollectionTour best;
  const auto consider = [&](const Strain& strain, Order order) {
    improve(strain, order);
    while (!order.empty() && !with_best_passes(strain, order).feasible) drop_one(strain, order);
    while (take_in(strain, order)) improve(strain, order);
    const CollectionTour plan = with_best_passes(strain, order);
    if (is_better(plan, best)) best = plan;
  };
  for (const FlightCost& weights :
       {FlightCost{1, 1, 1}, FlightCost{1, 0, 0}, FlightCost{0, 0, 1}}) {
    const Strain strain(problem, weights);
    consider(strain, nearest_neighbours(problem));
    consider(strain, {});
  }
  return best;
}

}  // namespace reconnaissance
