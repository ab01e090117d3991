// An algorithm from before Skein, wrapped as a planner of the navigator.
#include "navigator.idl.hpp"
#include "skein/component_registry.hpp"

/// The old algorithm: straight ahead, as high as its end that is higher. It knows no ground and no
/// zones.
extern "C" int straight_ahead(const double from[3], const double to[3], double way[3][3]) {
  const double top = from[2] > to[2] ? from[2] : to[2];
  for (int i = 0; i < 3; ++i) {
    way[i][0] = from[0] + (to[0] - from[0]) * i / 2;
    way[i][1] = from[1] + (to[1] - from[1]) * i / 2;
    way[i][2] = i == 0 ? from[2] : i == 1 ? top : to[2];
  }
  return 3;
}

/// The CSP: turns the managed interface's types into those of the algorithm, and back.
class StraightAhead : public AE_navigator::IPlanner {
 public:
  AE_navigator::Route plan(const AE_navigator::Problem& task) override {
    const double from[] = {task.start.north_m, task.start.east_m, task.start.altitude_m};
    const double to[] = {task.goal.north_m, task.goal.east_m, task.goal.altitude_m};
    double way[3][3];
    AE_navigator::Route route;
    route.planner = "StraightAhead";
    for (int i = 0; i < straight_ahead(from, to, way); ++i)
      route.waypoints.push_back({way[i][0], way[i][1], way[i][2]});
    return route;
  }
};

extern "C" std::uint32_t skein_plugin_abi() { return SKEIN_ABI; }

extern "C" void skein_register_components(skein::ComponentRegistry& registry) {
  registry.add_csp<AE_navigator::IPlanner>("StraightAhead", [](const skein::ParameterValues&) {
    return std::make_shared<AE_navigator::IPlanner::Skeleton>(std::make_shared<StraightAhead>());
  });
}
