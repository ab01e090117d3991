#pragma once

#include <string>
#include <string_view>

namespace skein::launch {

/// The environment variable by which a launcher knows again what its children started, also what
/// has left their process groups and sessions. It holds the mark of each launcher above, separated
/// by blanks.
inline constexpr const char* kMarkVariable = "SKEIN_LAUNCHED_BY";

/// A mark that no other launcher has.
std::string make_mark();

/// Kills every process whose environment holds `mark`, and those that they start meanwhile; waits
/// for the end of those that are children of this process. Out of reach are processes that were
/// started without their parent's environment, and those of another user. Allocates nothing, so
/// that it may be called between fork and exec.
void kill_marked_processes(std::string_view mark) noexcept;

}  // namespace skein::launch
