#pragma once

#include "skein/core/clock.hpp"

namespace skein {

/// Keeps work away from a CSP that fails. Closed: it works as usual. After so many faults in a row
/// it opens: the CSP is in quarantine. Then it is half-open: one request may probe it, and what
/// comes of that closes the breaker or opens it again for twice as long. Pure: time is an argument.
/// Not thread-safe.
class CircuitBreaker {
 public:
  enum class State { Closed, Open, HalfOpen };

  struct Rules {
    unsigned faults = 3;  ///< In a row: crashed, hung, late, or a result that was rejected.
    Duration first_quarantine = std::chrono::seconds(1);
    Duration longest_quarantine = std::chrono::seconds(60);
  };

  explicit CircuitBreaker(const Rules& rules) : rules_(rules) {}

  /// Open, too, while the one probe is under way.
  State state(Instant now) const noexcept;

  /// Until a probe is due; zero unless open.
  Duration quarantine(Instant now) const noexcept;

  /// To be called when the CSP is about to work: while half-open, that is the probe.
  void begin(Instant now) noexcept;

  void succeed() noexcept;
  void fail(Instant now) noexcept;
  /// A fault so grave that it opens at once.
  void trip(Instant now) noexcept;
  /// It ended without a word on the CSP: cancelled, or given too little time.
  void end() noexcept { probing_ = false; }

 private:
  Rules rules_;
  unsigned faults_ = 0;
  Duration quarantine_{};  // zero: closed
  Instant opened_{};
  bool probing_ = false;
};

const char* to_string(CircuitBreaker::State state) noexcept;

}  // namespace skein
