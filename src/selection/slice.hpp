#pragma once

#include <algorithm>
#include <cstddef>
#include <optional>

#include "skein/clock.hpp"

namespace skein {

/// A CSP that takes so many times as long as was expected of it hangs.
inline constexpr int kHangs = 4;

/// What is kept of the time that remains for others, beside a CSP that is expected to take
/// `latency` and fits: the least time that any of them is known to take, if there is so much.
/// Where nothing is known of any of them, an even share, out of what the first does not need.
inline Duration reserve_beside(Duration latency, std::optional<Duration> least_of_others,
                               std::size_t others, Duration remaining) {
  const Duration left = remaining - latency;
  if (least_of_others) return *least_of_others <= left ? *least_of_others : Duration::zero();
  const auto sharers = static_cast<Duration::rep>(others + 1);
  return others == 0 ? Duration::zero() : std::min(remaining / sharers, left);
}

/// How much of the time that remains a CSP gets when `reserve` is kept for another, by the latency
/// that is expected of it. All but the reserve; of plenty of time half: who has not answered by
/// then, and has had kHangs times that latency, will hardly do so.
inline Duration slice_beside(Duration latency, Duration reserve, Duration remaining) {
  if (reserve == Duration::zero() || reserve >= remaining) return remaining;
  return std::min(std::max(kHangs * latency, remaining / 2), remaining - reserve);
}

}  // namespace skein
