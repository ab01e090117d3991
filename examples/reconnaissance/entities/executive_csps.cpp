#include "executive_csps.hpp"

namespace reconnaissance {
namespace {

std::string words(const ModeDecision& decision) {
  switch (decision.cause) {
    case Cause::None:
      return "";
    case Cause::FuelLow:
      return "fuel suffices for the way home and no more";
    case Cause::FuelCritical:
      return "fuel does not suffice for the way home";
    case Cause::SensorOut:
      return "a set of sensors is not heard";
    case Cause::SensorsOut:
      return "one set of sensors is left, and nobody outvotes it";
    case Cause::NavigationLost:
      return "no set of sensors is heard";
    case Cause::EntityRestarts:
      return decision.entity + " does not answer";
    case Cause::EntityLost:
      return decision.entity + " is lost";
    case Cause::Forecast:
      break;
  }
  return "the mission is not worth its risk";
}

static_assert(static_cast<int>(FlightMode::Abort) ==
              static_cast<int>(recon::FlightOrder::LandAtOnce));

}  // namespace

template <class Choice>
recon::ExecutiveDecision Executive<Choice>::decide(const recon::ExecutiveSituation& told) {
  MissionSituation situation;
  situation.fuel_kg = told.fuel_kg;
  situation.fuel_for_mission_kg = told.fuel_for_mission_kg;
  situation.fuel_home_kg = told.fuel_home_kg;
  situation.fuel_reserve_kg = told.fuel_reserve_kg;
  situation.sensors = told.sensors;
  situation.sensors_voted_in = told.sensors_heard;
  for (const recon::MissingEntity& each : told.missing)
    situation.missing.push_back({each.name, each.required, each.given_up});
  const ModeDecision decision = choice_.decide(situation);
  return {static_cast<recon::FlightOrder>(static_cast<int>(decision.mode)), words(decision)};
}

template class Executive<RuleTableExecutive>;
template class Executive<UtilityExecutive>;

}  // namespace reconnaissance
