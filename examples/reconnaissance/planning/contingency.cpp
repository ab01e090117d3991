#include "planning/contingency.hpp"

#include <algorithm>
#include <cmath>

namespace reconnaissance {
namespace {

// In missions: what the loss of the aircraft costs.
constexpr double kAircraft = 5;
// Of what a flight burns, relative to what was forecast.
constexpr double kFuelDeviation = 0.1;
// Until the plan's end, by the next failures.
constexpr double kHazardOneChannelOut = 0.005, kHazardEntityMissing = 0.02;
// A change of mode has to bring at least that much.
constexpr double kAdvantage = 0.05;

const MissingEntity* find(const MissionSituation& situation, auto&& wanted) {
  const auto found = std::find_if(situation.missing.begin(), situation.missing.end(), wanted);
  return found == situation.missing.end() ? nullptr : &*found;
}

/// An entity that was lost may come back.
bool is_final(const ModeDecision& decision) {
  return decision.mode >= FlightMode::ReturnHome && decision.cause != Cause::EntityLost;
}

/// The last final mode stays, until there is a more severe one.
ModeDecision continued(ModeDecision& last, const ModeDecision& next) {
  if (next.mode <= last.mode) return last;
  if (is_final(next)) last = next;
  return next;
}

/// That a flight burns more than there is.
double probability_to_run_dry(double fuel_kg, double forecast_kg) {
  if (forecast_kg <= 0) return 0;
  const double deviations = (fuel_kg - forecast_kg) / (kFuelDeviation * forecast_kg);
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
  if (const MissingEntity* missing = find(s, [](const MissingEntity&) { return true; })) {
    return {FlightMode::Degraded, missing->given_up ? Cause::EntityLost : Cause::EntityRestarts,
            missing->name};
  }
  if (s.sensors_voted_in < s.sensors) return {FlightMode::Degraded, Cause::SensorOut, {}};
  return {};
}

ModeDecision RuleTableExecutive::decide(const MissionSituation& situation) {
  return continued(last_, allowed_mode(situation));
}

double UtilityExecutive::utility_of_mission(const MissionSituation& s) {
  const double hazard = kHazardOneChannelOut * (s.sensors - s.sensors_voted_in) +
                        kHazardEntityMissing * static_cast<double>(s.missing.size());
  const double dry = probability_to_run_dry(s.fuel_kg, s.fuel_for_mission_kg);
  const double survives = std::exp(-hazard) * (1 - dry);
  return survives - (1 - survives) * kAircraft;
}

double UtilityExecutive::utility_of_return(const MissionSituation& s) {
  return -kAircraft * probability_to_run_dry(s.fuel_kg, s.fuel_home_kg);
}

ModeDecision UtilityExecutive::decide(const MissionSituation& situation) {
  ModeDecision next = allowed_mode(situation);
  if (next.mode < FlightMode::ReturnHome &&
      utility_of_return(situation) > utility_of_mission(situation) + kAdvantage) {
    next = {FlightMode::ReturnHome, Cause::Forecast, {}};
  }
  return continued(last_, next);
}

}  // namespace reconnaissance
