#pragma once

#include <chrono>
#include <cstddef>
#include <functional>
#include <string>

#include "skein/entity/circuit_breaker.hpp"
#include "skein/entity/selection.hpp"

namespace skein {

/// How a Head decides. A mission profile sets all but the last two.
struct HeadOptions {
  /// For requests whose session names no other.
  std::string strategy = "declared";
  /// A file that holds the history: read at the start, where it is there, and written at the end.
  std::string history{};
  /// A file to which each decision is added as a line of JSON.
  std::string log{};
  /// The share of decisions in which `learned` may try a CSP only to learn of it.
  double exploration = 0.02;
  CircuitBreaker::Rules breaker{};
  /// So many CSPs in this process that do not return, and threads that one of them has cost (see
  /// Head), make the peer degraded. No more CSPs than that run on their callers' threads at a time.
  std::size_t most_stuck = 3;
  /// A CSP in this process of whose like runs half took no longer may run on its Body's thread (see
  /// Head): a change of threads would cost more than it protects. 0: none does, for Bodies that
  /// hold locks while they perform.
  Duration quick = std::chrono::microseconds(100);
  /// Told on the performing thread of a CSP in another process that took four times as long as was
  /// expected of it: it is quarantined, and whoever launched it may restart it. Must return soon.
  std::function<void(const Candidate&)> on_hang{};
};

}  // namespace skein
