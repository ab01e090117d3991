#pragma once

#include <chrono>
#include <string>

namespace skein {

/// `2026-11-24T23:47:14.123Z`, as all logs have it.
std::string utc_text(std::chrono::system_clock::time_point time);

}  // namespace skein
