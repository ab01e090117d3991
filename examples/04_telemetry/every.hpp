#pragma once

#include <poll.h>

#include <chrono>

/// Calls `act` once a period until the standard input has something to say, or ends.
template <class Act>
void every(std::chrono::milliseconds period, const Act& act) {
  auto next = std::chrono::steady_clock::now();
  for (;;) {
    act();
    next += period;
    const auto left = next - std::chrono::steady_clock::now();
    const auto wait = std::chrono::ceil<std::chrono::milliseconds>(left).count();
    pollfd input{0, POLLIN, 0};
    if (poll(&input, 1, wait > 0 ? static_cast<int>(wait) : 0) > 0) return;
  }
}
