#pragma once

#include <cstdint>
#include <vector>

namespace skein::benchmarks {

/// The cores that this process may use, ascending.
std::vector<int> allowed_cores();

/// Puts all threads of this process, and those that they will make, onto one core; -1 lets them go
/// wherever they might at the start. Throws Internal where the kernel refuses.
void place_all_threads(int core);

/// Processor time of this process so far, the kernel's part included.
std::int64_t used_cpu_ns();

}  // namespace skein::benchmarks
