// A planner and a navigator that return a straight line, whatever is in its way, and praise it; and
// a client that brings a planner which nobody can reach.

#include <cmath>
#include <cstdio>
#include <memory>
#include <string>

#include "navigation/routes/demo_problem.hpp"
#include "navigator.idl.hpp"
#include "skein/component_registry.hpp"
#include "skein/entity.hpp"
#include "skein/error.hpp"

namespace {

AE_navigator::Route straight_line(const AE_navigator::Problem& problem) {
  const auto& a = problem.start;
  const auto& b = problem.goal;
  AE_navigator::Route route;
  route.waypoints = {a, b};
  route.length_m =
      std::hypot(b.north_m - a.north_m, b.east_m - a.east_m, b.altitude_m - a.altitude_m);
  route.lowest_height_above_ground_m = problem.minimum_height_above_ground_m;
  route.radar_exposure = 0;
  route.planner = "ShortCut";
  return route;
}

class ShortCut final : public AE_navigator::IPlanner {
 public:
  AE_navigator::Route plan(const AE_navigator::Problem& task) override {
    return straight_line(task);
  }
};

class CarelessNavigator final : public AE_navigatorI::INavigator {
 public:
  AE_navigator::Route request_route(const AE_navigatorI::RouteRequest& request) override {
    return straight_line(request.problem);
  }
  AE_navigatorI::PlanningStatus status() override { return {}; }
  AE_navigatorI::PlanningReport report(const std::string& request_id) override {
    return {request_id, "none", {}, {}, "trust me", 0};
  }
};

int bring_unreachable_planner(skein::Entity& entity, const skein::ParameterValues&) {
  auto navigator = entity.connect<AE_navigatorI::INavigator>().within(std::chrono::seconds(20));
  AE_navigatorI::RouteRequest request;
  request.request_id = "unreachable";
  request.problem = skein::navigation::demo_problem(skein::navigation::make_synthetic_terrain(7));
  request.problem.time_limit_ms = 300;
  request.own_planner = skein::Reference<AE_navigator::IPlanner>(
      {"IDL:AE_navigator/IPlanner", skein::Guid::random(), ""});
  try {
    navigator.request_route(request);
    return 1;
  } catch (const skein::Error& error) {
    std::printf("refused: %s\n", error.what());
  }
  std::printf("reported: %s\n", navigator.report(request.request_id).failure.c_str());
  return 0;
}

}  // namespace

extern "C" std::uint32_t skein_plugin_abi() { return SKEIN_ABI; }

extern "C" void skein_register_components(skein::ComponentRegistry& registry) {
  registry.add_csp<AE_navigator::IPlanner>("ShortCut", [](const skein::ParameterValues&) {
    return std::make_shared<AE_navigator::IPlanner::Skeleton>(std::make_shared<ShortCut>());
  });
  registry.add_body<AE_navigatorI::INavigator>(
      "Navigator", [](skein::Entity&, const skein::ParameterValues&) {
        return skein::ComponentRegistry::Body{std::make_shared<AE_navigatorI::INavigator::Skeleton>(
                                                  std::make_shared<CarelessNavigator>()),
                                              2};
      });
  registry.add_mission("Stranger", bring_unreachable_planner);
}
