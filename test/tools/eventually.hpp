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

}  // namespace skein::test
