#pragma once

#include <cstdint>

namespace skein::dds {

/// What readers take of one sample, with its header: 256 MiB.
inline constexpr std::uint32_t kLargestSample = 256u << 20;

}  // namespace skein::dds
