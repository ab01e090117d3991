#pragma once

#include <cstdint>
#include <string>

namespace skein::command {

/// A time in nanoseconds since 1970 on this machine's clocks, in strftime's format.
std::string local_time(std::uint64_t nanoseconds, const char* format);

}  // namespace skein::command
