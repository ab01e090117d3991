#pragma once

#include <cstdint>

#include "skein/detail/version.hpp"

/// Number of libskein's binary interface. It grows whenever a class or function that modules and
/// plugins use changes its layout or meaning. A module that was built for another number is
/// refused.
#define SKEIN_ABI 24

namespace skein {

/// The number for which the caller was compiled.
inline constexpr std::uint32_t kAbi = SKEIN_ABI;

/// The number for which the loaded libskein was compiled.
extern "C" std::uint32_t skein_abi();

}  // namespace skein
