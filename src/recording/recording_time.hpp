#pragma once

#include <cstdint>
#include <optional>

namespace skein::recording {

/// What the machine's clocks show, in nanoseconds.
struct ClockTimes {
  std::uint64_t wall = 0;        ///< Since 1970; somebody may set it.
  std::uint64_t since_boot = 0;  ///< Nobody sets it, and it runs while the machine sleeps.
};

ClockTimes clock_times_now();

/// The times of a recording: what the wall clock showed at its start, and what has passed since.
/// So they stay in order if the wall clock is set meanwhile, as it is on a machine that starts in
/// 1970 and then hears of the time.
class RecordingTime {
 public:
  explicit RecordingTime(ClockTimes start = clock_times_now()) : start_(start) {}

  std::uint64_t start() const noexcept { return start_.wall; }
  std::uint64_t at(std::uint64_t since_boot) const noexcept {
    return start_.wall + (since_boot - start_.since_boot);
  }
  std::uint64_t now() const { return at(clock_times_now().since_boot); }

  /// By how many nanoseconds the wall clock was set since the last question, if it was. Not
  /// thread-safe, unlike the rest.
  std::optional<std::int64_t> step(ClockTimes now) noexcept;

 private:
  const ClockTimes start_;
  std::int64_t ahead_ = 0;  // of this recording's time, when step() was asked last
};

}  // namespace skein::recording
