#pragma once

#include <array>
#include <chrono>
#include <cstdint>

#include "skein/clock.hpp"

namespace reconnaissance {

/// The mission's time advances in ticks of 20 ms; tick 0 is its beginning.
using Tick = std::int64_t;
inline constexpr std::chrono::milliseconds kTick{20};
inline constexpr double kTick_s = std::chrono::duration<double>(kTick).count();

constexpr skein::Duration time_of(Tick tick) { return tick * skein::Duration(kTick); }

/// At every how many ticks one may take part: at 50, 25, 10, 5, 2 or 1 Hz.
inline constexpr std::array<int, 6> kPeriods{1, 2, 5, 10, 25, 50};

constexpr bool is_due(int period, Tick tick) { return tick % period == 0; }

}  // namespace reconnaissance
