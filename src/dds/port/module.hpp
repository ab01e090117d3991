#pragma once

#include <cstdint>

#include "dds/port/port.hpp"
#include "skein/detail/abi.hpp"

/// What a vendor's module (`libskein_<vendor>.so`) exports; load_vendor() looks for these two.
#define SKEIN_MODULE_EXPORT __attribute__((visibility("default")))

extern "C" {
/// The SKEIN_ABI with which the module was compiled.
SKEIN_MODULE_EXPORT std::uint32_t skein_module_abi();

/// The vendor; one object a process, owned by the module, which is never unloaded.
SKEIN_MODULE_EXPORT std::shared_ptr<skein::dds::Vendor>* skein_module_vendor();
}
