// What a process of the guide's mission loads.
#include <cstdio>

#include "navigator.hpp"
#include "skein/component_registry.hpp"
#include "skein/entity.hpp"
#include "skein/head.hpp"

extern "C" std::uint32_t skein_plugin_abi() { return SKEIN_ABI; }

extern "C" void skein_register_components(skein::ComponentRegistry& registry) {
  registry.add_csp<survey::IPlanner>("Rows", [](const skein::ParameterValues&) {
    return std::make_shared<survey::IPlanner::Skeleton>(std::make_shared<Rows>());
  });
  registry.add_csp<survey::IPlanner>("Spiral", [](const skein::ParameterValues&) {
    return std::make_shared<survey::IPlanner::Skeleton>(std::make_shared<Spiral>());
  });
  registry.add_body<survey::INavigator>(
      "Navigator", [](skein::Entity& entity, const skein::ParameterValues&) {
        return skein::ComponentRegistry::Body{std::make_shared<survey::INavigator::Skeleton>(
            std::make_shared<Navigator>(entity.head()))};
      });
  registry.add_mission("Station", [](skein::Entity& entity, const skein::ParameterValues&) {
    auto navigator = entity.connect<survey::INavigator>();
    const auto track = navigator.plan({.length_m = 400, .width_m = 300});
    std::printf("%s: %.0f m\n", track.planner.c_str(), track.length_m);
    return 0;  // the mission's exit code
  });
}
