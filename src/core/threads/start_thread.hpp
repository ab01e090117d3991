#pragma once

#include <string_view>
#include <system_error>
#include <thread>
#include <utility>

namespace skein {

/// Throws Unavailable: which thread, the system's reason, and what to do.
[[noreturn]] void refuse_thread(std::string_view name, const std::system_error& reason);

/// A thread that runs `run`. Throws Unavailable where the system gives none. It is for the thread
/// itself to take its name.
template <class Run>
std::thread start_thread(std::string_view name, Run&& run) {
  try {
    return std::thread(std::forward<Run>(run));
  } catch (const std::system_error& reason) {
    refuse_thread(name, reason);
  }
}

}  // namespace skein
