#include "skein/detail/circuit_breaker.hpp"

#include <algorithm>

namespace skein {

CircuitBreaker::State CircuitBreaker::state(Instant now) const noexcept {
  if (quarantine_ == Duration::zero()) return State::Closed;
  return probing_ || now < saturating_sum(opened_, quarantine_) ? State::Open : State::HalfOpen;
}

Duration CircuitBreaker::quarantine(Instant now) const noexcept {
  return std::max(Duration::zero(), saturating_sum(opened_, quarantine_) - now);
}

void CircuitBreaker::begin(Instant now) noexcept { probing_ = state(now) != State::Closed; }

void CircuitBreaker::succeed() noexcept {
  faults_ = 0;
  quarantine_ = Duration::zero();
  probing_ = false;
}

void CircuitBreaker::fail(Instant now) noexcept {
  probing_ = false;
  if (++faults_ >= rules_.faults || quarantine_ > Duration::zero()) trip(now);
}

void CircuitBreaker::trip(Instant now) noexcept {
  probing_ = false;
  quarantine_ = quarantine_ == Duration::zero()
                    ? rules_.first_quarantine
                    : std::min(saturating_sum(quarantine_, quarantine_), rules_.longest_quarantine);
  opened_ = now;
}

}  // namespace skein
