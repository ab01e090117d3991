// A plugin whose author forgot `extern "C"`, once.
#include "skein/component_registry.hpp"

extern "C" std::uint32_t skein_plugin_abi() { return skein::kAbi; }

void skein_register_components(skein::ComponentRegistry& registry);
void skein_register_components(skein::ComponentRegistry&) {}
