#pragma once

#include <chrono>
#include <cstdint>

namespace skein {

/// Now by the system's clock, as what entities tell and record has it.
inline std::uint64_t nanoseconds_since_1970() {
  const auto now = std::chrono::system_clock::now().time_since_epoch();
  return static_cast<std::uint64_t>(std::chrono::nanoseconds(now).count());
}

}  // namespace skein
