#pragma once

#include <chrono>

namespace skein::test {

/// Linked into a program, it puts a wall clock of its own between the program with its libraries
/// and the machine's. This sets that clock forward by `step`, or back where it is negative: whoever
/// waits until a time on it waits until it shows that time. Thread-safe.
void step_wall_clock(std::chrono::seconds step);

}  // namespace skein::test
