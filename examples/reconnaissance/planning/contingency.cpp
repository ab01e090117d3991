#include "planning/contingency.hpp"

#include <algorithm>
#include <cmath>

namespace reconnaissance {
namespace {

const MissingEntity* find(const MissionSituation& situation, auto&& wanted) {
  const auto found = std::find_if(situation.missing.begin(), situation.missing.end(), wanted);
  return found == situation.missing.end() ? nullptr : &*found;
}

bool is_final(FlightMode mode) { return mode >= FlightMode::ReturnHome; }

/// Final modes stay; leaving the contingency route resumes the mission.
ModeDecision continued(const ModeDecision& last, ModeDecision next) {
  if (is_final(last.mode) && next.mode <= last.mode) {
    next = last;
  }
  next.resumes =
      last.mode == FlightMode::ContingencyRoute && next.mode < FlightMode::ContingencyRoute;
  return next;
}

/// That a flight burns more than there is.
double probability_to_run_dry(double fuel_kg, double forecast_kg, double relative_deviation) {
  if (forecast_kg <= 0) return 0;
  const double deviations = (fuel_kg - forecast_kg) / (relative_deviation * forecast_kg);
  return std::erfc(deviations / std::sqrt(2.0)) / 2;
}

}  // namespace

ModeDecision allowed_mode(const MissionSituation& s) {
  const auto is_lost = [](const MissingEntity& one) { return one.required && one.given_up; };
  if (const MissingEntity* lost = find(s, is_lost)) {
    return {FlightMode::Abort, Cause::EntityLost, lost->name};
  }
  if (s.sensors_voted_in == 0) return {FlightMode::Abort, Cause::NavigationLost, {}};
  if (s.fuel_kg < s.fuel_home_kg) return {FlightMode::Abort, Cause::FuelCritical, {}};
  if (s.fuel_kg < s.fuel_home_kg + s.fuel_reserve_kg) {
    return {FlightMode::ReturnHome, Cause::FuelLow, {}};
  }
  if (s.sensors > 1 && s.sensors_voted_in == 1) {
    return {FlightMode::ReturnHome, Cause::SensorsOut, {}};
  }
  if (s.link == Link::Lost) return {FlightMode::ContingencyRoute, Cause::LinkLost, {}};
  if (const MissingEntity* missing = find(s, [](const MissingEntity&) { return true; })) {
    return {FlightMode::Degraded, missing->given_up ? Cause::EntityLost : Cause::EntityRestarts,
            missing->name};
  }
  if (s.sensors_voted_in < s.sensors) return {FlightMode::Degraded, Cause::SensorOut, {}};
  if (s.link == Link::Degraded) return {FlightMode::Degraded, Cause::LinkDegraded, {}};
  return {};
}

ModeDecision RuleTableExecutive::decide(const MissionSituation& situation) {
  last_ = continued(last_, allowed_mode(situation));
  return last_;
}

double UtilityExecutive::utility_of_mission(const MissionSituation& s) const {
  double hazard = s.hazard_left;
  hazard += weights_.hazard_one_channel_out * (s.sensors - s.sensors_voted_in);
  hazard += weights_.hazard_entity_missing * static_cast<double>(s.missing.size());
  const double dry =
      probability_to_run_dry(s.fuel_kg, s.fuel_for_mission_kg, weights_.fuel_deviation);
  const double survives = std::exp(-hazard) * (1 - dry);
  return survives * s.value_left - (1 - survives) * weights_.aircraft;
}

double UtilityExecutive::utility_of_return(const MissionSituation& s) const {
  return -weights_.aircraft *
         probability_to_run_dry(s.fuel_kg, s.fuel_home_kg, weights_.fuel_deviation);
}

ModeDecision UtilityExecutive::decide(const MissionSituation& situation) {
  ModeDecision next = allowed_mode(situation);
  const bool flies_plan = next.mode < FlightMode::ContingencyRoute;
  if (flies_plan &&
      utility_of_return(situation) > utility_of_mission(situation) + weights_.advantage) {
    next = {FlightMode::ReturnHome, Cause::Forecast, {}};
  }
  last_ = continued(last_, next);
  return last_;
}

}  // namespace reconnaissance
