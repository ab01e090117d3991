#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "test/tools/child_process.hpp"

namespace skein::test {

/// What a process of the fault matrix holds.
struct Footprint {
  std::size_t threads = 0;
  std::size_t descriptors = 0;
  std::size_t shared_memory = 0;  ///< Mappings of files in /dev/shm.
  std::size_t resident_kib = 0;
  std::size_t heap_kib = 0;  ///< What is in use of it.
};

/// Throws where the process has ended.
Footprint footprint_of(ChildProcess& process);

/// Checks that a process that was looked at round by round, idle, and always did the same between,
/// holds no more and more: at its least in the last quarter of the rounds no more than at its least
/// in the second one, but for `kHeapSlackKib` and `kResidentSlackKib`. The first quarter warms up.
/// Prints one line.
void check_flat(const std::string& who, const std::vector<Footprint>& rounds);

/// What comes and goes without a leak: a large message that the vendor keeps until the next one,
/// and what the allocator does not give back.
inline constexpr std::size_t kHeapSlackKib = 1024;
inline constexpr std::size_t kResidentSlackKib = 8 * 1024;

}  // namespace skein::test
