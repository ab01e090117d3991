#pragma once

#include <cstddef>
#include <string_view>

namespace skein::launch {

/// The environment variable that names the pipe on which a process reports that it is ready.
inline constexpr const char* kReadyVariable = "SKEIN_READY_FD";

/// More bytes of a reason are not passed on: so much goes through a pipe in one piece.
inline constexpr std::size_t kLongestReason = 2048;

/// Tells the launcher that this process is ready: it answers calls, and what it depends on is
/// there. Every call after the first, and any call in a process without a launcher, does nothing.
/// Any process can do the same without this library, by writing a byte to the descriptor whose
/// number stands in SKEIN_READY_FD (in a shell: `echo >&$SKEIN_READY_FD`). A process that does not
/// within its ready timeout is taken for hung. Callable from any thread.
void report_ready() noexcept;

/// Tells the launcher what this process waits for before it is ready: the last such reason stands
/// in what the launcher says where the process does not become ready. Without this library: write a
/// line that begins with `?`. Does nothing after report_ready() and without a launcher.
void report_waiting(std::string_view reason) noexcept;

}  // namespace skein::launch
