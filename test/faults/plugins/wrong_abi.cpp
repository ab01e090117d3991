// A module and a plugin of a Skein that does not exist.
#include <cstdint>

extern "C" {
std::uint32_t skein_module_abi() { return 9999; }
std::uint32_t skein_plugin_abi() { return 9999; }
}
