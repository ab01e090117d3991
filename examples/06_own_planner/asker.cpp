// A mission of one question, and why it was answered as it was.
#include <cstdio>

#include "navigator.idl.hpp"
#include "skein/core/abi.hpp"
#include "skein/entity/component_registry.hpp"
#include "skein/entity/entity.hpp"
#include "skein/navigation/demo_problem.hpp"

extern "C" std::uint32_t skein_plugin_abi() { return SKEIN_ABI; }

extern "C" void skein_register_components(skein::ComponentRegistry& registry) {
  registry.add_mission("Asker", [](skein::Entity& entity, const skein::ParameterValues&) {
    auto navigator = entity.connect<AE_navigatorI::INavigator>();
    AE_navigatorI::RouteRequest request;
    request.request_id = "across";
    request.problem = skein::navigation::demo_problem(skein::navigation::make_synthetic_terrain(7));
    const auto route = navigator.within(std::chrono::seconds(20)).request_route(request);
    for (const auto& attempt : navigator.report(request.request_id).attempts) {
      std::printf("%s\n  %s after %.1f ms %s\n", attempt.reason.c_str(), attempt.outcome.c_str(),
                  attempt.took_ms, attempt.text.c_str());
    }
    std::printf("%s: %.1f km\n", route.planner.c_str(), route.length_m / 1000);
    return 0;
  });
}
