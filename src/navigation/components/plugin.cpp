// What a process of a mission loads to be the navigator, the flight controller, the AD manager or
// one of the planners.

#include "ad_manager.hpp"
#include "flight_controller.hpp"
#include "navigation/planners/planners.hpp"
#include "navigator.hpp"
#include "planner_csp.hpp"
#include "skein/component_registry.hpp"

using skein::ComponentRegistry;
using skein::ParameterValues;

extern "C" std::uint32_t skein_plugin_abi() { return SKEIN_ABI; }

extern "C" void skein_register_components(ComponentRegistry& registry) {
  namespace navigation = skein::navigation;
  const auto terrains = std::make_shared<navigation::TerrainProvider>();

  registry.add_body<AE_flightControllerI::IFlightController>(
      "FlightController", [](skein::Entity&, const ParameterValues& values) {
        auto body = std::make_shared<navigation::FlightController>(values);
        return ComponentRegistry::Body{
            std::make_shared<AE_flightControllerI::IFlightController::Skeleton>(std::move(body))};
      });
  registry.add_body<AE_adManagerI::IAdManager>(
      "AdManager", [terrains](skein::Entity&, const ParameterValues&) {
        auto body = std::make_shared<navigation::AdManager>(terrains);
        return ComponentRegistry::Body{
            std::make_shared<AE_adManagerI::IAdManager::Skeleton>(std::move(body))};
      });
  registry.add_body<AE_navigatorI::INavigator>(
      "Navigator", [terrains](skein::Entity& entity, const ParameterValues& values) {
        auto body = std::make_shared<navigation::Navigator>(entity, values, terrains);
        return ComponentRegistry::Body{
            std::make_shared<AE_navigatorI::INavigator::Skeleton>(std::move(body)),
            navigation::Navigator::kThreads};
      });
  std::vector<std::string> planners = navigation::planner_names();
  planners.emplace_back("LegacyDubins");
  for (const std::string& planner : planners) {
    registry.add_csp<AE_navigator::IPlanner>(
        planner, [terrains, planner](const ParameterValues& values) {
          return navigation::make_planner_csp(planner, terrains, values);
        });
  }
}
