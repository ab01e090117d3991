#include "lead.hpp"

#include <chrono>

namespace skein::same_host {
namespace {

// Who has been away for longer is stood in for.
constexpr std::chrono::milliseconds kLate{10};
// Then who stands by sleeps until the lead is left again.
constexpr int kLooksInVain = 3;

}  // namespace

bool Lead::take() noexcept {
  const std::uint64_t state = state_;
  return is_free(state) && take_back(state);
}

bool Lead::take_back(std::uint64_t left) noexcept {
  if (!state_.compare_exchange_strong(left, left + 1)) return false;
  given_up_ = false;
  return true;
}

std::uint64_t Lead::leave() noexcept {
  const std::uint64_t left = ++state_;
  if (watched_ == 0 && watched_.exchange(1) == 0) futex_wake(watched_);
  return left;
}

void Lead::give_up() noexcept {
  given_up_ = true;
  ++state_;
  wake();
}

void Lead::wake() noexcept {
  watched_ = 2;
  futex_wake(watched_);
}

bool Lead::stand_by(const std::function<bool()>& stopping) {
  std::uint64_t seen = state_;
  Instant since = std::chrono::steady_clock::now();
  int in_vain = 0;
  while (true) {
    watched_ = 1;
    if (stopping()) return false;
    const std::uint64_t state = state_;
    const Instant now = std::chrono::steady_clock::now();
    ++in_vain;
    if (state != seen) {
      seen = state;
      since = now;
      in_vain = 0;
    }
    if (is_free(state) && (given_up_ || now - since >= kLate) && take_back(state)) return true;
    if (in_vain < kLooksInVain || is_free(state)) {
      futex_wait(watched_, 1, now + kLate);
    } else {
      watched_ = 0;
      if (state_ == seen && !stopping()) futex_wait(watched_, 0, Instant::max());
      in_vain = 0;
    }
  }
}

void Lead::end() {
  while (!take()) {
    watched_ = 0;
    if (!is_free(state_)) futex_wait(watched_, 0, Instant::max());
  }
}

}  // namespace skein::same_host
