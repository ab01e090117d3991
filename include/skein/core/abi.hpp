#pragma once

#include <cstdint>

/// The number of libskein's binary interface. It grows whenever a class or function that modules
/// and plugins use changes its layout or its meaning; a module built against another number is
/// refused.
#define SKEIN_ABI 4

namespace skein {

/// The number with which the caller was compiled.
inline constexpr std::uint32_t kAbi = SKEIN_ABI;

/// The number with which the loaded libskein was compiled.
extern "C" std::uint32_t skein_abi();

}  // namespace skein
