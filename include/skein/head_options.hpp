#pragma once

#include <chrono>
#include <cstddef>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "skein/detail/circuit_breaker.hpp"

namespace skein {

class SelectionStrategy;
struct Candidate;

/// How a Head decides. A mission profile sets all fields but `strategies`, which its plugins add,
/// and `on_hang`.
struct HeadOptions {
  /// Strategy for requests whose session names none.
  std::string strategy = "declared";
  /// Strategies in addition to Skein's own; `strategy` may name one of them.
  std::vector<std::shared_ptr<const SelectionStrategy>> strategies{};
  /// File of the history: read at the start if it exists, written at the end. Empty: none.
  std::string history{};
  /// File to which each decision is appended as a line of JSON; at 64 MiB `x.jsonl` becomes
  /// `x.1.jsonl`, in place of an earlier one. Empty: none.
  std::string log{};
  /// Share of decisions in which `learned` may try a CSP only to learn about it.
  double exploration = 0.02;
  CircuitBreaker::Rules breaker{};
  /// The peer is degraded if this many CSPs in its process do not return.
  std::size_t max_stuck = 3;
  /// Called on the performing thread when a CSP in another process has timed out after at least
  /// four times its expected time. The CSP is quarantined; its launcher may restart it. Must return
  /// soon.
  std::function<void(const Candidate&)> on_hang{};
};

}  // namespace skein
