#pragma once

#include <algorithm>

#include "skein/clock.hpp"

namespace skein {

/// A CSP that takes so many times as long as was expected of it hangs.
inline constexpr int kHangs = 4;

/// How much of the time that remains a CSP gets when `reserve` is kept for another, by the latency
/// that is expected of it. All but the reserve; of plenty of time half: who has not answered by
/// then, and has had kHangs times that latency, will hardly do so.
inline Duration slice_beside(Duration latency, Duration reserve, Duration remaining) {
  if (reserve == Duration::zero()) return remaining;
  return std::min(std::max(kHangs * latency, remaining / 2), remaining - reserve);
}

}  // namespace skein
