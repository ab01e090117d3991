#pragma once

#include "skein/clock.hpp"

namespace skein {

/// Keeps work away from a CSP that fails. Closed: normal operation. Open: after several faults in a
/// row the CSP is in quarantine. Half-open: after the quarantine one request may probe it; a
/// success closes the breaker, a fault opens it again for twice as long. Pure: time is an argument.
/// Not thread-safe.
class CircuitBreaker {
 public:
  enum class State { Closed, Open, HalfOpen };

  struct Rules {
    unsigned faults = 3;  ///< In a row: crash, hang, undeclared error or rejected result.
    Duration first_quarantine = std::chrono::seconds(1);
    Duration longest_quarantine = std::chrono::seconds(60);
  };

  explicit CircuitBreaker(const Rules& rules) : rules_(rules) {}

  /// Open also while the probe is under way.
  State state(Instant now) const noexcept;

  /// Time until a probe is due; zero unless open.
  Duration quarantine(Instant now) const noexcept;

  /// Call it when the CSP begins to work; unless closed, this is the probe.
  void begin(Instant now) noexcept;

  void succeed() noexcept;
  void fail(Instant now) noexcept;
  /// A fault so serious that it opens at once.
  void trip(Instant now) noexcept;
  /// The run shows nothing about the CSP: it was cancelled, say, or had too little time.
  void end() noexcept { probing_ = false; }

 private:
  Rules rules_;
  unsigned faults_ = 0;
  Duration quarantine_{};  // zero: closed
  Instant opened_{};
  bool probing_ = false;
};

}  // namespace skein
