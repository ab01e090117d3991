// A plugin that cannot register its components.
#include <stdexcept>

#include "skein/component_registry.hpp"

extern "C" std::uint32_t skein_plugin_abi() { return skein::kAbi; }

extern "C" void skein_register_components(skein::ComponentRegistry&) {
  throw std::runtime_error("licence missing");
}
