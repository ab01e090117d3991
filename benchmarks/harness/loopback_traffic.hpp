#pragma once

#include <cstdint>

namespace skein::benchmarks {

/// What this process's network has sent over loopback so far, headers included.
struct LoopbackTraffic {
  std::int64_t octets = 0;
  std::int64_t packets = 0;
};

/// Throws Skipped where the kernel does not tell.
LoopbackTraffic loopback_traffic();

}  // namespace skein::benchmarks
