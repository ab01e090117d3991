#include "recording/recording_time.hpp"

#include <cstdlib>
#include <ctime>

#include "core/wall_clock.hpp"

namespace skein::recording {
namespace {

/// What comes between the looks at both clocks is less.
constexpr std::int64_t kLeastStep = 100'000'000;

std::uint64_t nanoseconds_since_boot() {
  timespec now{};
  ::clock_gettime(CLOCK_BOOTTIME, &now);
  return static_cast<std::uint64_t>(now.tv_sec) * 1'000'000'000 +
         static_cast<std::uint64_t>(now.tv_nsec);
}

}  // namespace

ClockTimes clock_times_now() {
  // A thread that was stopped between both looks would see a step.
  constexpr std::uint64_t kAtOnce = 10'000'000;
  ClockTimes now;
  for (int tries = 0; tries < 100; ++tries) {
    now = {nanoseconds_since_1970(), nanoseconds_since_boot()};
    if (nanoseconds_since_1970() - now.wall < kAtOnce) break;
  }
  return now;
}

std::optional<std::int64_t> RecordingTime::step(ClockTimes now) noexcept {
  const auto ahead = static_cast<std::int64_t>(now.wall - at(now.since_boot));
  const std::int64_t step = ahead - ahead_;
  if (std::abs(step) < kLeastStep) return std::nullopt;
  ahead_ = ahead;
  return step;
}

}  // namespace skein::recording
