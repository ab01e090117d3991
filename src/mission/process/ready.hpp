#pragma once

#include <cstddef>
#include <string_view>

#include "mission/profile/process_start.hpp"

namespace skein::launch {

using profile::kReadyVariable;

/// More bytes of a reason are not passed on: so much goes through a pipe in one piece.
inline constexpr std::size_t kLongestReason = 2048;

/// Tells the launcher that this process is ready: it answers calls, and what it depends on is
/// there. Every call after the first, and any call in a process without a launcher, does nothing.
/// Any process can do the same without this library, by writing a byte to the descriptor whose
/// number stands in SKEIN_READY_FD (in a shell: `echo >&$SKEIN_READY_FD`). A process that does not
/// within its ready timeout is taken for hung. Callable from any thread.
void report_ready() noexcept;

/// Tells the launcher that this process, which is ready, makes progress: without this library, by
/// one more byte. Does nothing before report_ready(); never blocks.
void report_progress() noexcept;

/// Tells the launcher what this process waits for before it is ready, or what keeps it from making
/// progress: the last such reason stands in what the launcher says of its end. Without this
/// library: write a line that begins with `?`.
void report_waiting(std::string_view reason) noexcept;

}  // namespace skein::launch
