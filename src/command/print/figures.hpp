#pragma once

#include <cstdint>
#include <string>

/// Figures in few characters, for tables.
namespace skein::command {

/// `350 us`, `4.2 ms`, `12 s`, `3 min`, `2 h`, `5 d`.
std::string short_time(std::uint64_t nanoseconds);

/// `800 B`, `12 KiB`, `34 MiB`, `1.2 GiB`.
std::string short_size(std::uint64_t bytes);

/// With one digit behind the point below ten: `0.3`, `12`, `1234`.
std::string short_number(double value);

}  // namespace skein::command
