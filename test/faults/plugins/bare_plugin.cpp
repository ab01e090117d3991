// A plugin that has not got further than its first line.
#include "skein/component_registry.hpp"

extern "C" std::uint32_t skein_plugin_abi() { return SKEIN_ABI; }
