// A mission of one question, and why it was answered as it was.
#include <cstdio>

#include "navigator.idl.hpp"
#include "skein/component_registry.hpp"
#include "skein/entity.hpp"

namespace {

/// Around a city, on terrain that everybody can make.
AE_navigator::Problem across() {
  AE_navigator::Problem problem;
  problem.terrain = "synthetic:7";
  problem.start = {5000, 5000, 2500};
  problem.goal = {38000, 40000, 2500};
  problem.no_fly_zones = {{"City", {{20000, 21000}}, 5000, 0, 20000}};
  problem.minimum_height_above_ground_m = 120;
  problem.limits = {60, 12, 30, 6000};
  problem.exposure_weight = 1;
  return problem;
}

}  // namespace

extern "C" std::uint32_t skein_plugin_abi() { return SKEIN_ABI; }

extern "C" void skein_register_components(skein::ComponentRegistry& registry) {
  registry.add_mission("Asker", [](skein::Entity& entity, const skein::ParameterValues&) {
    auto navigator = entity.connect<AE_navigatorI::INavigator>();
    AE_navigatorI::RouteRequest request;
    request.request_id = "across";
    request.problem = across();
    const auto route = navigator.within(std::chrono::seconds(20)).request_route(request);
    for (const auto& attempt : navigator.report(request.request_id).attempts) {
      std::printf("%s\n  %s after %.1f ms %s\n", attempt.reason.c_str(), attempt.outcome.c_str(),
                  attempt.took_ms, attempt.text.c_str());
    }
    std::printf("%s: %.1f km\n", route.planner.c_str(), route.length_m / 1000);
    return 0;
  });
}
