// A plugin that is not linked with what it calls.
#include "skein/component_registry.hpp"

namespace charts {
double depth_m(double x_m, double y_m);
}

extern "C" std::uint32_t skein_plugin_abi() { return SKEIN_ABI; }

extern "C" void skein_register_components(skein::ComponentRegistry& registry) {
  registry.add_mission("sounding", [](skein::Entity&, const skein::ParameterValues&) {
    return charts::depth_m(0, 0) > 0 ? 0 : 1;
  });
}
