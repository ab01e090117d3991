#pragma once

#include <string>
#include <string_view>

namespace skein::launch {

/// While it lives, the launcher knows what this process does before it is ready, and so does
/// whoever reads what it says when it dies of that (see report_crashes()). Only the main thread
/// makes one, and one at a time.
class StartStep {
 public:
  /// Follows `it`: `loads the plugin 'survey'`.
  explicit StartStep(const std::string& what);
  ~StartStep();
  StartStep(const StartStep&) = delete;
  StartStep& operator=(const StartStep&) = delete;
};

/// From now on, when code in this process makes it die of a signal, the process tells on stderr,
/// and the launcher, in which thread, or in which StartStep, and writes the thread's stack to
/// stderr; then it dies as it would have. One that ends by exit() within a StartStep says so, too,
/// and ends with kStartFailed.
void report_crashes();

/// A line of that stack with the C++ name of its function; another line unchanged.
std::string with_readable_symbols(std::string_view line);

}  // namespace skein::launch
