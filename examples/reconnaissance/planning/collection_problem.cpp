#include "planning/collection_problem.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace reconnaissance {
namespace {

bool is_cost(const FlightCost& cost) {
  const auto good = [](double part) { return std::isfinite(part) && part >= 0; };
  return good(cost.seconds) && good(cost.fuel_kg) && good(cost.hazard);
}

}  // namespace

FlightCost& FlightCost::operator+=(const FlightCost& other) {
  seconds += other.seconds;
  fuel_kg += other.fuel_kg;
  hazard += other.hazard;
  return *this;
}

bool covers(const FlightCost& a, const FlightCost& b) {
  return a.seconds <= b.seconds && a.fuel_kg <= b.fuel_kg && a.hazard <= b.hazard;
}

FlightCost FlightLimits::most() const {
  return {endurance_s, fuel_kg,
          least_survival > 0 ? -std::log(least_survival) : std::numeric_limits<double>::infinity()};
}

std::optional<std::string> excess(const FlightCost& estimate, const FlightLimits& limits) {
  constexpr double kRounding = 1e-9;
  const FlightCost most = limits.most();
  if (estimate.hazard > most.hazard + kRounding)
    return fmt::format("survives with a probability of {:.3f}, at least {:.3f}",
                       std::exp(-estimate.hazard), limits.least_survival);
  if (estimate.seconds > most.seconds)
    return fmt::format("takes {:.0f} s, at most {:.0f}", estimate.seconds, most.seconds);
  if (estimate.fuel_kg > most.fuel_kg)
    return fmt::format("burns {:.1f} kg, at most {:.1f}", estimate.fuel_kg, most.fuel_kg);
  return std::nullopt;
}

CollectionProblem::CollectionProblem(const RoutePose& start, const RoutePose& landing,
                                     std::vector<CollectionTask> tasks, const Leg& leg,
                                     const FlightLimits& limits)
    : tasks_(std::move(tasks)), limits_(limits.most()) {
  if (tasks_.size() > 48) throw std::invalid_argument("more than 48 collection tasks");
  std::vector<CollectionPass> passes{{start, start, {}}};
  for (std::size_t task = 0; task < tasks_.size(); ++task) {
    if (tasks_[task].passes.empty()) throw std::invalid_argument("a collection task has no pass");
    if (!(tasks_[task].value > 0)) throw std::invalid_argument("a collection task has no value");
    first_node_.push_back(passes.size());
    for (const CollectionPass& pass : tasks_[task].passes) {
      passes.push_back(pass);
      task_of_.push_back(task);
    }
  }
  passes.push_back({landing, landing, {}});
  for (const CollectionPass& from : passes) {
    for (const CollectionPass& to : passes) {
      steps_.push_back(leg(from.end, to.begin) + to.cost);
      if (!is_cost(steps_.back())) {
        throw std::invalid_argument("the cost of a leg or pass is negative or not finite");
      }
    }
  }
}

bool is_better(const CollectionTour& a, const CollectionTour& b) {
  if (a.feasible != b.feasible) return a.feasible;
  const double same = 1e-9 * std::max(a.value, b.value);
  if (std::abs(a.value - b.value) > same) return a.value > b.value;
  return a.cost.seconds < b.cost.seconds;
}

}  // namespace reconnaissance
