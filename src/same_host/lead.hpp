#pragma once

#include <atomic>
#include <cstdint>
#include <functional>

#include "futex.hpp"

namespace skein::same_host {

/// The right to take messages, which one thread has at a time, the leader of the pattern "leader
/// and followers"; nobody has it at first. Who leaves it may take it back as long as no other one
/// has taken it meanwhile. Thread-safe.
///
/// Memory order. What the leader alone uses is handed on by `state_`: leave() releases it, take()
/// acquires it. A thread that stands by writes `watched_`, then reads `state_`; one that leaves
/// writes `state_`, then reads `watched_`. These are sequentially consistent, so that one of both
/// sees the other's write.
class Lead {
 public:
  /// False where somebody has it.
  bool take() noexcept;

  /// By who has it, and is to be back soon: who stands by takes it after 10 ms, or 20 at most.
  /// Returns what take_back() is told.
  std::uint64_t leave() noexcept;
  /// Whether nobody has taken it since.
  bool is_left(std::uint64_t left) const noexcept { return state_ == left; }
  /// False where another one has taken it since.
  bool take_back(std::uint64_t left) noexcept;

  /// By who has it, and does not come back: who stands by takes it at once.
  void give_up() noexcept;

  /// Waits until it can be taken, and takes it; false once `stopping`, which wake() makes it look
  /// at. By one thread at a time.
  bool stand_by(const std::function<bool()>& stopping);
  void wake() noexcept;

  /// By who has let all others know that they are to leave: takes it for good.
  void end();

 private:
  static bool is_free(std::uint64_t state) noexcept { return state % 2 != 0; }

  // Odd while nobody has it.
  std::atomic<std::uint64_t> state_{1};
  std::atomic<bool> given_up_{false};
  // 0 while who stands by sleeps until it is left, 1 while he looks now and then, 2: he is to look
  // now.
  Word watched_{1};
};

}  // namespace skein::same_host
