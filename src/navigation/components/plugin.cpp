// What a process of a mission loads to be the navigator, the flight controller, the AD manager or
// one of the planners.

#include <algorithm>

#include "ad_manager.hpp"
#include "flight_controller.hpp"
#include "navigation/planners/planners.hpp"
#include "navigator.hpp"
#include "skein/component_registry.hpp"

using skein::ComponentRegistry;
using skein::ParameterValues;

namespace {

using namespace skein::navigation;

template <class Interface, class Make>
void add_body(ComponentRegistry& registry, const char* name, std::size_t threads, Make make) {
  registry.add_body<Interface>(
      name, [=](skein::Entity& entity, const ParameterValues& values) -> ComponentRegistry::Body {
        return {std::make_shared<typename Interface::Skeleton>(make(entity, values)), threads};
      });
}

/// `Time limit` is the most time that a planner takes for a route,
/// `Seed` the start of its random numbers, `Exposure cap` the most exposure of CappedAStar's
/// routes. It stops as soon as nobody waits for its answer any more.
PlannerOptions planner_options(const ParameterValues& values) {
  using std::chrono::milliseconds;
  PlannerOptions options;
  options.seed = values.find<std::uint32_t>("Seed").value_or(options.seed);
  options.exposure_cap_m = values.find<double>("Exposure cap").value_or(options.exposure_cap_m);
  if (const auto limit = values.find<milliseconds>("Time limit"))
    options.time_limit_ms = static_cast<std::uint32_t>(std::max(milliseconds(1), *limit).count());
  return options;
}

}  // namespace

extern "C" std::uint32_t skein_plugin_abi() { return SKEIN_ABI; }

extern "C" void skein_register_components(ComponentRegistry& registry) {
  const auto terrains = std::make_shared<TerrainProvider>();
  add_body<AE_flightControllerI::IFlightController>(
      registry, "FlightController", 1, [](skein::Entity&, const ParameterValues& values) {
        return std::make_shared<FlightController>(values);
      });
  add_body<AE_adManagerI::IAdManager>(registry, "AdManager", 1,
                                      [terrains](skein::Entity&, const ParameterValues&) {
                                        return std::make_shared<AdManager>(terrains);
                                      });
  add_body<AE_navigatorI::INavigator>(
      registry, "Navigator", Navigator::kThreads,
      [terrains](skein::Entity& entity, const ParameterValues& values) {
        return std::make_shared<Navigator>(entity, values, terrains);
      });
  std::vector<std::string> planners = planner_names();
  planners.emplace_back("LegacyDubins");
  for (const std::string& planner : planners) {
    registry.add_csp<AE_navigator::IPlanner>(
        planner, [terrains, planner](const ParameterValues& values) {
          return std::make_shared<AE_navigator::IPlanner::Skeleton>(
              make_planner(planner, terrains, planner_options(values)));
        });
  }
}
