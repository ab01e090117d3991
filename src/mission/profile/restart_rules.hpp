#pragma once

#include <array>
#include <chrono>
#include <string_view>

namespace skein::profile {

enum class RestartPolicy {
  Never,      ///< A process that ended stays ended.
  OnFailure,  ///< Started again after an exit code other than 0, a signal, or a start-up that hung.
  Always,     ///< Started again whatever it ended with.
};

/// The words of the XML, in the order of the policies.
inline constexpr std::array<std::string_view, 3> kRestartWords{"never", "on-failure", "always"};
constexpr std::string_view to_string(RestartPolicy policy) noexcept {
  return kRestartWords[static_cast<std::size_t>(policy)];
}

/// When a process is started again, and when no more.
///
/// The n-th restart inside of `window` waits for `delay` × 2^(n-1), at most `max_delay`. A process
/// that ends when it was restarted `max_restarts` times within the last `window` is given up. A
/// restart after which the process did not become ready counts without end.
struct RestartRules {
  RestartPolicy policy = RestartPolicy::Never;
  std::chrono::nanoseconds delay = std::chrono::milliseconds(100);
  std::chrono::nanoseconds max_delay = std::chrono::seconds(5);
  int max_restarts = 5;
  std::chrono::nanoseconds window = std::chrono::seconds(30);
};

/// What the loss of a process means for the mission. A process is lost when it has ended, was not
/// meant to, and is not started again.
enum class LossPolicy {
  Abort,     ///< The mission ends, and has failed.
  Degrade,   ///< The mission goes on; that it was degraded is told, and shows in the exit code.
  Continue,  ///< The mission goes on as if nothing had happened.
};

/// The words of the XML, in the order of the policies.
inline constexpr std::array<std::string_view, 3> kLossWords{"abort", "degrade", "continue"};

/// What the launcher demands of one process.
struct ProcessRules {
  RestartRules restart;
  std::chrono::nanoseconds ready_timeout = std::chrono::seconds(30);  ///< Start to "I am ready".
  /// The longest time between two signs of progress once it is ready; zero: none is asked for.
  std::chrono::nanoseconds progress_timeout{0};
  /// SIGINT to SIGKILL; SIGTERM comes after two thirds of it.
  std::chrono::nanoseconds stop_timeout = std::chrono::seconds(3);
  LossPolicy on_loss = LossPolicy::Abort;
};

}  // namespace skein::profile
