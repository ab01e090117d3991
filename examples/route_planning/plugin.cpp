#include "ground_station.hpp"
#include "skein/component_registry.hpp"

extern "C" std::uint32_t skein_plugin_abi() { return SKEIN_ABI; }

extern "C" void skein_register_components(skein::ComponentRegistry& registry) {
  registry.add_mission("GroundStation",
                       [](skein::Entity& entity, const skein::ParameterValues& values) {
                         return route_planning::GroundStation(entity, values).fly() ? 0 : 1;
                       });
}
