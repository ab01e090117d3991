#pragma once

#include <chrono>
#include <thread>

namespace skein::test {

/// A limit that only a broken program reaches, on a loaded machine too.
inline constexpr std::chrono::seconds kPatience{20};

/// Waits until `condition()` holds; false where it does not within `limit`. Tests wait for
/// conditions with it, never for time.
template <class Condition>
bool eventually(Condition&& condition, std::chrono::steady_clock::duration limit = kPatience) {
  const auto end = std::chrono::steady_clock::now() + limit;
  while (!condition()) {
    if (std::chrono::steady_clock::now() >= end) return condition();
    std::this_thread::sleep_for(std::chrono::milliseconds(2));
  }
  return true;
}

/// Calls `attempt(limit)` with longer and longer limits until it returns true. For calls that are
/// to run out of time only after something has happened: how long that takes a loaded machine is
/// not known beforehand.
template <class Attempt>
bool with_enough_time(std::chrono::milliseconds limit, Attempt&& attempt) {
  for (; limit < kPatience; limit *= 2) {
    if (attempt(limit)) return true;
  }
  return false;
}

}  // namespace skein::test
