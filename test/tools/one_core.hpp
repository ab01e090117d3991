#pragma once

#include <sched.h>

#include <catch2/catch.hpp>
#include <cstddef>

namespace skein::test {

/// Keeps this thread, and those that it starts meanwhile, on the core where it is.
struct OneCore {
  OneCore() {
    sched_getaffinity(0, sizeof before, &before);
    cpu_set_t here;
    CPU_ZERO(&here);
    CPU_SET(static_cast<std::size_t>(sched_getcpu()), &here);
    REQUIRE(sched_setaffinity(0, sizeof here, &here) == 0);
  }
  ~OneCore() { sched_setaffinity(0, sizeof before, &before); }

  cpu_set_t before{};
};

}  // namespace skein::test
