#include "tour_csps.hpp"

#include <stdexcept>
#include <vector>

#include "threat_conversion.hpp"

namespace reconnaissance {
namespace {

constexpr int kSteps = 300'000;

RoutePose pose(const recon::RoutePose& told) {
  return {told.north_m, told.east_m, told.course_rad};
}

CollectionProblem problem_of(const recon::TourProblem& told) {
  std::vector<CollectionTask> tasks;
  for (const recon::TourTask& each : told.tasks) {
    CollectionTask& task = tasks.emplace_back();
    task.value = each.value;
    for (const recon::TourPass& pass : each.passes)
      task.passes.push_back(
          {pose(pass.begin), pose(pass.end), {pass.seconds, pass.fuel_kg, pass.hazard}});
  }
  const std::vector<ThreatDisc> discs = discs_of(told.weapons);
  const CruiseFigures cruise{told.speed_m_s, told.turn_radius_m, told.fuel_kg_s};
  const auto leg = [&](const RoutePose& from, const RoutePose& to) {
    return cost_of_leg(from, to, discs, cruise);
  };
  return {pose(told.start), pose(told.landing), std::move(tasks), leg,
          FlightLimits{told.endurance_s, told.fuel_kg, told.least_survival}};
}

}  // namespace

recon::Tour TourPlanner::plan(const recon::TourProblem& problem) {
  try {
    const CollectionTour found = plan_(problem_of(problem));
    if (!found.feasible) throw recon::NoTour("not even the way home is within the limits");
    recon::Tour tour{{}, found.value, found.cost.seconds, found.cost.fuel_kg, found.cost.hazard};
    for (const Collection& each : found.collections)
      tour.stops.push_back(
          {static_cast<std::uint32_t>(each.task), static_cast<std::uint32_t>(each.pass)});
    return tour;
  } catch (const std::invalid_argument& error) {
    throw recon::NoTour(error.what());
  }
}

CollectionTour bounded_search(const CollectionProblem& problem) {
  int steps = 0;
  return branch_and_bound_plan(problem, [&] { return ++steps < kSteps; }).plan;
}

}  // namespace reconnaissance
